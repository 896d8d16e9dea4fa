#pragma once
// Lights, sky and exposure of a model.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"
#include "world/render_description.h"
#include "world/visual_material.h"

namespace gloam {

/// How much light there is, for the exposure.
struct LightLevels {
  std::vector<float> illuminance;  ///< [lx] of each active light, facing it at the model's centre
  bool photometric = false;        ///< an active light has an intensity in cd
};

/// Fills lights (headlight last) and sky. `poses` = X_WB at qpos0.
LightLevels describe_light(const mjModel& model, const std::vector<Affine3f>& poses,
                           MaterialTable* materials, RenderDescription* out);

/// EV100 of the described scene, whose textures are loaded.
float exposure(const LightLevels& levels, const RenderDescription& scene);

}  // namespace gloam

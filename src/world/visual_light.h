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

  /// Counts a lamp of known intensity, `distance` [m] from the model's centre.
  void add(const LightDescription& light, float distance);
};

/// From the model's centre to a light at p_W [m]; not less than a share of the model's extent.
float light_distance(const mjModel& model, Vec3f p_W);

/// Adds the model's lights (headlight last) and its sky. `poses` = X_WB at qpos0; `levels` = of
/// lights that are there already; returned with the model's.
LightLevels describe_light(const mjModel& model, const std::vector<Affine3f>& poses,
                           LightLevels levels, MaterialTable* materials, RenderDescription* out);

/// EV100 of the described scene, whose textures are loaded.
float exposure(const LightLevels& levels, const RenderDescription& scene);

}  // namespace gloam

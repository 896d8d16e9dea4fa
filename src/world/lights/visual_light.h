#pragma once
// Lights, sky and exposure of a model.

#include <mujoco/mujoco.h>

#include <vector>

#include "base/vec.h"
#include "gloam/scene.h"
#include "world/materials/visual_material.h"
#include "world/render_description.h"

namespace gloam {

/// Amount of light, for the exposure.
struct LightLevels {
  std::vector<float> illuminance;  ///< [lx] of each active light, facing it at the model's centre
  bool photometric = false;        ///< an active light has an intensity in cd, or the scene says
                                   ///< what light there is

  /// Counts a lamp of known intensity, `distance` [m] from the model's centre.
  void add(const LightDescription& light, float distance);
};

/// Adds the model's lights (headlight last) and its sky. `poses` = X_WB at qpos0; `levels` = of
/// lights that are there already; returned with the model's. What stands in for a sky in a model is
/// left out where `scene` has one, and so is an automatic headlight where it has lamps.
LightLevels describe_light(const mjModel& model, const Scene& scene,
                           const std::vector<Affine3f>& poses, LightLevels levels,
                           MaterialTable* materials, RenderDescription* out);

/// Distance at which a light at p_W is assumed to be looked at [m]: that of the scene's centre, or
/// a quarter of its extent if that is further.
float light_distance(Vec3f p_W, const RenderDescription& scene);

/// EV100 of the described scene, whose textures are loaded.
float exposure(const LightLevels& levels, const RenderDescription& scene);

}  // namespace gloam

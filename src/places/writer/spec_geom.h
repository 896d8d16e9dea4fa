#pragma once
// Settings that geoms added to a spec by Gloam have in common.

#include <mujoco/mujoco.h>

#include <optional>
#include <string>

#include "gloam/types.h"

namespace gloam {

inline constexpr int kVisualGroup = 2, kColliderGroup = 3;

/// Names the element `text`, or `text`_2, _3 … where the spec has an element of its kind with that
/// name already. Returns the name. For elements that nobody looks up: geoms, meshes, textures.
std::string set_free_name(mjsElement* element, const std::string& text);

/// MuJoCo's own defaults, for elements that must not take those of the environment's <default>: its
/// scale of meshes, its meshes and materials, that its geoms collide with nothing.
const mjsDefault* own_defaults();

/// Into the fields of an element of a spec.
void write_pose(const Pose& X, double* pos, double* quat);

/// Empty = the model's default stays.
void write_friction(const std::optional<Vec3>& friction, mjsGeom* geom);

/// A collider that is only drawn on request: translucent blue, in kColliderGroup. `defaults`
/// nullptr: those of the environment.
mjsGeom* add_collider_geom(mjsBody* body, const std::string& name, const mjsDefault* defaults);

}  // namespace gloam

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

/// Into the fields of an element of a spec.
void write_pose(const Pose& X, double* pos, double* quat);

/// Empty = the model's default stays.
void write_friction(const std::optional<Vec3>& friction, mjsGeom* geom);

/// A collider that is only drawn on request: translucent blue, in kColliderGroup.
mjsGeom* add_collider_geom(mjsBody* body, const std::string& name);

}  // namespace gloam

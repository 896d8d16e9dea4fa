#pragma once
// Places of glTF's nodes: a matrix, or translation, rotation and scale.

#include <array>

#include "geometry/gltf/json_node.h"

namespace gloam {

/// Pose of the node N in its parent P, X_PN, scale included. Errors: no affine map, no rotation.
Affine3f place_in_parent(const JsonNode& node);

/// Makes the quaternion x y z w one of length one; false where it has none.
bool normalize_rotation(std::array<float, 4>* q);

/// Scales, then turns by the unit quaternion x y z w.
Affine3f place_from(const std::array<float, 4>& q, Vec3f scale);

}  // namespace gloam

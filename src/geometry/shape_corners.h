#pragma once
// Simple shapes about the origin as triangles: three corners after each other, wound either way.

#include <vector>

#include "base/vec.h"

namespace gloam {

using ShapeCorners = std::vector<Vec3f>;

void add_triangle(Vec3f a, Vec3f b, Vec3f c, ShapeCorners* out);
/// `half`: edges [m].
void add_box_corners(Vec3f half, ShapeCorners* out);
/// A surface of 16 sides about z through rings of (radius in x, in y, z), closed at both ends.
void add_lathe_corners(const std::vector<Vec3f>& rings, ShapeCorners* out);
/// Half axes [m]; a cylinder of that half length stands between the halves: an ellipsoid without,
/// of one radius a capsule.
void add_ball_corners(Vec3f radii, float half_length, ShapeCorners* out);

}  // namespace gloam

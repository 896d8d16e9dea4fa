#pragma once
// Convex hulls of points.

#include <span>
#include <vector>

#include "geometry/mesh/mesh.h"

namespace gloam {

struct HullLimits {
  int vertices = INT32_MAX;  ///< at most; the points that stick out most are taken
  double tolerance = 0;      ///< points that stick out by less are left out [m]
};

/// Triangles of the convex hull, counter-clockwise seen from outside; vertices are some of the
/// points. Points are told apart by a millionth of the longest side of their bounding box. Empty
/// where all of them lie in a plane.
TriangleMesh convex_hull(std::span<const Vec3f> points, const HullLimits& limits = {});

}  // namespace gloam

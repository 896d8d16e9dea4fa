#pragma once
// Smooth closed surfaces that are blended of round solids (Blinn 1982; polynomial blends after
// Quilez 2013), as triangles by surface nets (Gibson 1998).

#include <vector>

#include "base/vec.h"
#include "geometry/mesh/mesh.h"

namespace gloam {

/// A cone with round ends from a to b, or with a == b a ball; distances along x count `flat` times,
/// so that a trunk is wider than it is deep.
struct RoundSolid {
  Vec3f a, b;            ///< [m]
  float ra = 0, rb = 0;  ///< radii [m]
  float flat = 1;
};

/// Half-space on the side of p that n, a unit vector, points to.
struct CutPlane {
  Vec3f p, n;
};

struct ImplicitShape {
  std::vector<RoundSolid> solids;
  float blend = 0.03f;  ///< distance over which solids blend into each other [m]
  std::vector<CutPlane> cuts;

  /// Negative inside; near the surface about the distance [m].
  float distance(Vec3f p) const;
};

/// With cells of `cell` [m].
TriangleMesh mesh_of(const ImplicitShape& shape, float cell);

}  // namespace gloam

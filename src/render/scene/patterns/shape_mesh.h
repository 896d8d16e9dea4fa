#pragma once
// Analytic shapes as triangles.

#include "geometry/mesh/mesh.h"
#include "world/shapes/shape_type.h"

namespace gloam {

/// Triangles of an analytic shape in its frame G, counter-clockwise seen from outside. Round shapes
/// are kRoundSegments-gons about z, inscribed. `horizon`: half extents of an infinite plane [m].
TriangleMesh shape_mesh(ShapeType shape, Vec3f size, float horizon);

inline constexpr int kRoundSegments = 64;

}  // namespace gloam

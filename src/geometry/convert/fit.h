#pragma once
// Boxes, spheres, cylinders and capsules around a convex hull.

#include "geometry/convert/collider.h"

namespace gloam {

/// The smallest box around the hull that lies flat on one of its faces.
MeshCollider box_around(const TriangleMesh& hull);
/// The smallest sphere, within a thousandth.
MeshCollider sphere_around(const TriangleMesh& hull);
/// The smallest along an axis of the box around it; a capsule's axis is turned further while that
/// makes it smaller.
MeshCollider cylinder_around(const TriangleMesh& hull);
MeshCollider capsule_around(const TriangleMesh& hull);

}  // namespace gloam

#pragma once
// Convex solids that stand for a mesh in collisions, in the mesh's frame M.

#include <span>
#include <vector>

#include "geometry/convert/mass.h"
#include "gloam/types.h"

namespace gloam {

enum class MeshColliderType { kBox, kSphere, kCylinder, kCapsule, kHull };

struct MeshCollider {
  MeshColliderType type = MeshColliderType::kHull;
  /// Box: half of its sides; sphere: radius; cylinder, capsule (along z): radius, half of the
  /// length without caps [m].
  Vec3d size;
  AffineOf<double> X_MG;  ///< pose of the box, sphere, cylinder or capsule; rigid
  TriangleMesh hull;      ///< kHull: its surface, in M
};

const char* word_of(MeshColliderType type);

double volume_of(const MeshCollider& collider);

/// Its surface in M; of round ones a fine mesh within.
TriangleMesh surface_of(const MeshCollider& collider);

/// Distance of points to the surface of one collider, below 0 inside.
class ColliderDistance {
 public:
  explicit ColliderDistance(const MeshCollider& collider);
  double operator()(Vec3d p_M) const;

 private:
  struct Plane {
    Vec3d normal;
    double offset;
  };
  double from_hull(Vec3d p) const;
  const MeshCollider& collider_;
  std::vector<Plane> planes_;  // planes of a hull's triangles
};

/// Rotation of a rigid map.
Quat quaternion_of(const AffineOf<double>& X);

}  // namespace gloam

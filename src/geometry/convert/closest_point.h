#pragma once
// Distances to the surface of a mesh, and what is inside it.

#include <array>
#include <memory>

#include "geometry/bvh/bvh_build.h"
#include "geometry/convert/mass.h"

namespace gloam {

using Triangle3d = std::array<Vec3d, 3>;
Triangle3d triangle_of(const TriangleMesh& mesh, size_t triangle);

/// Squared distance to the nearest point of a triangle, edges included [m^2].
double squared_distance(Vec3d p, const Triangle3d& triangle);

/// Answers from any thread. The mesh outlives it.
class MeshQueries {
 public:
  explicit MeshQueries(const TriangleMesh& mesh);
  /// To the nearest point of the surface [m]; `most` if there is none nearer.
  double distance(Vec3d p, double most = 1e300) const;
  /// True inside of a closed mesh: by the number of its triangles above the point.
  bool is_inside(Vec3d p) const;

 private:
  const TriangleMesh& mesh_;
  BvhTree tree_;
};

struct SurfacePoint {
  Vec3d p, normal;
};
/// `count` points spread evenly over the surface, always the same; none where it has no area.
std::vector<SurfacePoint> sample_surface(const TriangleMesh& mesh, size_t count);

}  // namespace gloam

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/convert/closest_point.h"
#include "geometry/convert/convert.h"

namespace gloam {
namespace {

constexpr size_t kSurfaceSamples = 10'000, kVolumeSamples = 40'000;

// Below 0 inside one of the colliders; of points in several the deepest counts.
double distance_to(const std::vector<ColliderDistance>& colliders, Vec3d p) {
  double least = 1e300;
  for (const ColliderDistance& c : colliders) least = std::min(least, c(p));
  return least;
}

template <class Point, class F>
std::vector<double> for_each(const std::vector<Point>& points, F&& f) {
  std::vector<double> out(points.size());
  parallel_for_range("overlap", static_cast<int64_t>(points.size()), 64,
                     [&](int64_t begin, int64_t end) {
                       for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
                         out[i] = f(points[i]);
                     });
  return out;
}

// Points of a box, evenly, by the sequence R3 (Roberts 2018).
std::vector<Vec3d> points_in(const BvhBox& box) {
  constexpr double kRoot = 1.22074408460575947536;  // root of x^4 = x + 1
  const Vec3f side = box.high - box.low;
  std::vector<Vec3d> out;
  for (size_t i = 0; i < kVolumeSamples; ++i) {
    const auto n = static_cast<double>(i + 1);
    out.push_back({box.low.x + side.x * std::fmod(n / kRoot, 1.0),
                   box.low.y + side.y * std::fmod(n / (kRoot * kRoot), 1.0),
                   box.low.z + side.z * std::fmod(n / (kRoot * kRoot * kRoot), 1.0)});
  }
  return out;
}

}  // namespace

Overlap overlap_of(const Converted& converted) {
  Overlap out;
  if (converted.colliders.empty()) return out;
  std::vector<TriangleMesh> surfaces;
  BvhBox box;
  for (const MeshCollider& c : converted.colliders) surfaces.push_back(surface_of(c));
  for (const TriangleMesh& s : surfaces)
    for (const Vec3f p : s.positions) box.add(p);
  for (const Vec3f p : converted.mesh.positions) box.add(p);
  std::vector<ColliderDistance> colliders(converted.colliders.begin(), converted.colliders.end());
  const MeshQueries mesh(converted.mesh);
  // From the mesh to the colliders; from what of them is outside of all others to the mesh.
  std::vector<double> distances =
      for_each(sample_surface(converted.mesh, kSurfaceSamples),
               [&](const SurfacePoint& s) { return std::abs(distance_to(colliders, s.p)); });
  TriangleMesh all;
  for (const TriangleMesh& s : surfaces) {
    const auto first = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), s.positions.begin(), s.positions.end());
    for (const uint32_t i : s.indices) all.indices.push_back(first + i);
  }
  // Just above a wall that two colliders share is the inside of one of them.
  const double above = 1e-3 * length(box.high - box.low);
  const std::vector<double> back =
      for_each(sample_surface(all, kSurfaceSamples), [&](const SurfacePoint& s) {
        return distance_to(colliders, s.p + s.normal * above) < 0 ? -1 : mesh.distance(s.p);
      });
  for (const double d : back)
    if (d >= 0) distances.push_back(d);
  for (const double d : distances) {
    out.mean_distance += d / static_cast<double>(distances.size());
    out.max_distance = std::max(out.max_distance, d);
  }
  const Vec3f side = box.high - box.low;
  const double cell = double{side.x} * side.y * side.z / kVolumeSamples;
  // 1: in the mesh, 2: in a collider.
  size_t in_both = 0, in_any = 0, in_collider = 0;
  for (const double where : for_each(points_in(box), [&](Vec3d p) {
         return (converted.is_closed && mesh.is_inside(p) ? 1 : 0) +
                (distance_to(colliders, p) < 0 ? 2 : 0);
       })) {
    in_both += where == 3 ? 1 : 0;
    in_any += where > 0 ? 1 : 0;
    in_collider += where >= 2 ? 1 : 0;
  }
  out.collider_volume = cell * static_cast<double>(in_collider);
  if (!converted.is_closed) return out;
  out.mesh_volume = converted.mass.volume;
  if (in_any > 0) out.shared = static_cast<double>(in_both) / static_cast<double>(in_any);
  return out;
}

}  // namespace gloam

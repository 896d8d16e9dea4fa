#include "metrics/builtin/shortest_way.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"

namespace gloam {

ShortestWays::ShortestWays(const CompiledWorld& world, const MetricInstant& instant) {
  if (world.agents.empty()) return;
  auto made = NavWorld::create(world, *instant.model, *instant.data);
  if (!made.ok()) {
    log_warning("shortest paths to goals are approximated by straight lines: {}",
                made.error().to_string());
    return;
  }
  nav_ = std::move(*made);
  nav_->reset(*instant.model, *instant.data);
}

double ShortestWays::length(const Vec3& from, const Vec3& to) const {
  const double straight = std::hypot(to.x - from.x, to.y - from.y);
  if (nav_ == nullptr) return straight;
  constexpr double kSnapRadius = 1, kSnapHeight = 1.5;  // of places that are not on the mesh [m]
  const NavMesh& mesh = nav_->mesh_of(0);
  const NavPoint start = mesh.nearest(to_vec3d(from), kSnapRadius, kSnapHeight);
  const NavPoint end = mesh.nearest(to_vec3d(to), kSnapRadius, kSnapHeight);
  if (start.ref == 0 || end.ref == 0 || !mesh.are_connected(start, end)) return straight;
  const double way = length_on_mesh(mesh, start, end);
  const double beside = flat_norm(to_vec3d(from) - start.p) + flat_norm(to_vec3d(to) - end.p);
  return std::max(straight, way + beside);
}

// Detour returns a few corners at a time: the path is searched again from the last of them.
double ShortestWays::length_on_mesh(const NavMesh& mesh, const NavPoint& from,
                                    const NavPoint& to) const {
  constexpr int kCorners = 8, kMostSearches = 256;
  constexpr double kGoalTolerance = 0.01;  // [m]
  double length = 0;
  NavPoint at = from;
  for (int i = 0; i < kMostSearches && at.ref != 0; ++i) {
    NavPath path;
    path.reset(at);
    if (!path.find(mesh, to)) break;
    Vec3d corners[kCorners];
    const int count = path.corners(mesh, corners, kCorners);
    Vec3d last = at.p;
    for (int k = 0; k < count; ++k) {
      length += flat_norm(corners[k] - last);
      last = corners[k];
    }
    if (count == 0 || flat_norm(last - at.p) < kGoalTolerance) break;
    if (flat_norm(last - to.p) < kGoalTolerance) return length;
    at = mesh.nearest(last, 0.1, 0.5);
  }
  return length + flat_norm(to.p - at.p);
}

}  // namespace gloam

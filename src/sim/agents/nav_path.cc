#include <recastnavigation/DetourCommon.h>
#include <recastnavigation/DetourLocalBoundary.h>
#include <recastnavigation/DetourObstacleAvoidance.h>
#include <recastnavigation/DetourPathCorridor.h>

#include "base/check.h"
#include "sim/agents/nav_impl.h"

namespace gloam {
namespace {

constexpr int kMostPolys = 256;  // limit of a path; the rest is searched on the way
constexpr int kMostCorners = 8;
constexpr int kLookAhead = 8;  // polygons

// Velocity obstacles as Detour's crowds have them at medium quality; a horizon of 2.5 s is that at
// which pedestrians react (Karamouzas, Skinner and Guy 2014).
constexpr dtObstacleAvoidanceParams kAvoidance = {.velBias = 0.4f,
                                                  .weightDesVel = 2,
                                                  .weightCurVel = 0.75f,
                                                  .weightSide = 0.75f,
                                                  .weightToi = 2.5f,
                                                  .horizTime = 2.5f,
                                                  .gridSize = 33,
                                                  .adaptiveDivs = 7,
                                                  .adaptiveRings = 2,
                                                  .adaptiveDepth = 3};

}  // namespace

struct NavPath::Impl {
  dtPathCorridor corridor;
};

NavPath::NavPath() : impl_(std::make_unique<Impl>()) {
  const bool made = impl_->corridor.init(kMostPolys);
  GLOAM_CHECK(made, "out of memory for a path");
}
NavPath::NavPath(NavPath&&) noexcept = default;
NavPath::~NavPath() = default;

void NavPath::reset(const NavPoint& at) {
  float p[3];
  to_recast(at.p, p);
  impl_->corridor.reset(at.ref, p);
}

bool NavPath::find(const NavMesh& mesh, const NavPoint& goal) {
  const NavMesh::Impl& m = mesh.impl();
  float to[3];
  to_recast(goal.p, to);
  dtPolyRef polys[kMostPolys];
  int count = 0;
  const dtPolyRef first = impl_->corridor.getFirstPoly();
  if (first == 0) return false;
  m.query.findPath(first, goal.ref, impl_->corridor.getPos(), to, &m.filter, polys, &count,
                   kMostPolys);
  if (count == 0) return false;
  const bool is_whole = polys[count - 1] == goal.ref;
  if (!is_whole) m.query.closestPointOnPoly(polys[count - 1], to, to, nullptr);
  impl_->corridor.setCorridor(to, polys, count);
  return is_whole || count == kMostPolys;
}

Vec3d NavPath::end() const { return from_recast(impl_->corridor.getTarget()); }

bool NavPath::is_valid(const NavMesh& mesh) const {
  const NavMesh::Impl& m = mesh.impl();
  return impl_->corridor.getFirstPoly() != 0 &&
         impl_->corridor.isValid(kLookAhead, const_cast<dtNavMeshQuery*>(&m.query), &m.filter);
}

int NavPath::corners(const NavMesh& mesh, Vec3d* out, int most) {
  const NavMesh::Impl& m = mesh.impl();
  float corners[3 * kMostCorners];
  unsigned char flags[kMostCorners];
  dtPolyRef polys[kMostCorners];
  const int count = impl_->corridor.findCorners(corners, flags, polys, std::min(most, kMostCorners),
                                                const_cast<dtNavMeshQuery*>(&m.query), &m.filter);
  for (int i = 0; i < count; ++i) out[i] = from_recast(corners + 3 * i);
  // The funnel is cut short where what lies ahead can be seen.
  if (count > 0) {
    impl_->corridor.optimizePathVisibility(corners, 8, const_cast<dtNavMeshQuery*>(&m.query),
                                           &m.filter);
  }
  return count;
}

Vec3d NavPath::move(const NavMesh& mesh, Vec3d p) {
  const NavMesh::Impl& m = mesh.impl();
  float to[3];
  to_recast(p, to);
  impl_->corridor.movePosition(to, const_cast<dtNavMeshQuery*>(&m.query), &m.filter);
  return from_recast(impl_->corridor.getPos());
}

NavPoint NavPath::at() const {
  return {from_recast(impl_->corridor.getPos()), impl_->corridor.getFirstPoly()};
}

struct NavAvoidance::Impl {
  dtObstacleAvoidanceQuery query;
  dtLocalBoundary boundary;
};

NavAvoidance::NavAvoidance() : impl_(std::make_unique<Impl>()) {
  const bool made = impl_->query.init(kMostCircles, kMostWalls);
  GLOAM_CHECK(made, "out of memory for obstacle avoidance");
}
NavAvoidance::~NavAvoidance() = default;

void NavAvoidance::clear() { impl_->query.reset(); }

void NavAvoidance::add_circle(Vec3d p, double radius, Vec3d velocity, Vec3d wanted) {
  float at[3], v[3], w[3];
  to_recast(p, at), to_recast(velocity, v), to_recast(wanted, w);
  impl_->query.addCircle(at, static_cast<float>(radius), v, w);
}

void NavAvoidance::add_walls(const NavMesh& mesh, const NavPoint& around, double reach) {
  const NavMesh::Impl& m = mesh.impl();
  float p[3];
  to_recast(around.p, p);
  impl_->boundary.update(around.ref, p, static_cast<float>(reach),
                         const_cast<dtNavMeshQuery*>(&m.query), &m.filter);
  for (int i = 0; i < impl_->boundary.getSegmentCount(); ++i) {
    const float* s = impl_->boundary.getSegment(i);
    if (dtTriArea2D(p, s, s + 3) < 0) continue;  // seen from behind
    impl_->query.addSegment(s, s + 3);
  }
}

Vec3d NavAvoidance::choose(Vec3d p, double radius, double fastest, Vec3d velocity, Vec3d wanted) {
  float at[3], v[3], w[3], chosen[3] = {};
  to_recast(p, at), to_recast(flat(velocity), v), to_recast(flat(wanted), w);
  impl_->query.sampleVelocityAdaptive(at, static_cast<float>(radius), static_cast<float>(fastest),
                                      v, w, chosen, &kAvoidance);
  return flat(from_recast(chosen));
}

}  // namespace gloam

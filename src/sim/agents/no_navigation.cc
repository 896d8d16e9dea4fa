// The navigation mesh of builds without Recast.

#include "sim/agents/nav_mesh.h"

namespace gloam {

struct NavMesh::Impl {};
NavMesh::NavMesh() = default;
NavMesh::~NavMesh() = default;
Result<std::unique_ptr<NavMesh>> NavMesh::create(const NavSettings&) {
  return Error{ErrorKind::kUnsupported,
               "people and vehicles require Recast, which this build does not include",
               {},
               "install librecast-dev and rebuild, or remove [[agent]] and [[crowd]]"};
}
bool NavMesh::clear() { return false; }
int NavMesh::columns() const { return 0; }
int NavMesh::rows() const { return 0; }
NavBounds NavMesh::tile_reach(int, int) const { return {}; }
NavTile NavMesh::build_tile(int, int, std::span<const ColliderSurface* const>) const { return {}; }
void NavMesh::set_tile(int, int, const NavTile&) {}
void NavMesh::find_parts() {}
double NavMesh::area() const { return 0; }
NavPoint NavMesh::nearest(Vec3d, double, double) const { return {}; }
NavPoint NavMesh::nearest(Vec3d) const { return {}; }
NavPoint NavMesh::random_point(const NavPoint&, double, double, double) const { return {}; }
int NavMesh::part_of(const NavPoint&) const { return -1; }
double NavMesh::area_around(const NavPoint&) const { return 0; }
bool NavMesh::are_connected(const NavPoint&, const NavPoint&) const { return false; }

struct NavPath::Impl {};
NavPath::NavPath() = default;
NavPath::NavPath(NavPath&&) noexcept = default;
NavPath::~NavPath() = default;
void NavPath::reset(const NavPoint&) {}
bool NavPath::find(const NavMesh&, const NavPoint&) { return false; }
Vec3d NavPath::end() const { return {}; }
bool NavPath::is_valid(const NavMesh&) const { return false; }
int NavPath::corners(const NavMesh&, Vec3d*, int) { return 0; }
Vec3d NavPath::move(const NavMesh&, Vec3d p) { return p; }
NavPoint NavPath::at() const { return {}; }

struct NavAvoidance::Impl {};
NavAvoidance::NavAvoidance() = default;
NavAvoidance::~NavAvoidance() = default;
void NavAvoidance::clear() {}
void NavAvoidance::add_circle(Vec3d, double, Vec3d, Vec3d) {}
void NavAvoidance::add_walls(const NavMesh&, const NavPoint&, double) {}
Vec3d NavAvoidance::choose(Vec3d, double, double, Vec3d, Vec3d wanted) { return wanted; }

}  // namespace gloam

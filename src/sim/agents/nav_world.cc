#include "sim/agents/nav_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "base/check.h"
#include "base/hash.h"
#include "base/parallel.h"

namespace gloam {
namespace {

constexpr size_t kChunk = 512;  // triangles of a ground that are looked at as one
// Margin around agents and their goals, where a plane has no end [m]
constexpr double kPlaneMargin = 12;
constexpr float kSquare = 1;                 // edge of a square in the map of surfaces [m]
constexpr double kLeastLeaf = 0.7;           // half the height of a door's leaf [m]
constexpr double kMovingSpeed = 0.05;        // faster is moving [m/s]
constexpr double kDisplacedDistance = 0.15;  // further from where it lay is away [m]
constexpr double kRestTime = 0.5;            // until a thing is at rest [s]
constexpr double kRobotRestTime = 3;         // a robot pauses [s]
constexpr float kMinObstacleEdge = 0.12f;    // edge below which a thing is in nobody's way [m]
constexpr double kLeastPart = 4;             // least area of a mesh that somebody is put on [m²]
constexpr float kInf = std::numeric_limits<float>::infinity();

bool can_collide(const mjModel& m, int geom) {
  return m.geom_contype[geom] != 0 || m.geom_conaffinity[geom] != 0;
}

void extend(NavBounds* box, Vec3f low, Vec3f high) {
  box->low = {min(box->low.x, low.x), min(box->low.y, low.y), min(box->low.z, low.z)};
  box->high = {max(box->high.x, high.x), max(box->high.y, high.y), max(box->high.z, high.z)};
}

bool meet(const NavBounds& box, const ColliderSurface& s) {
  return s.low.x <= box.high.x && s.high.x >= box.low.x && s.low.y <= box.high.y &&
         s.high.y >= box.low.y;
}

// The box of a geom in the world.
void bound_geom(const mjModel& m, const mjData& d, int g, NavBounds* box) {
  const mjtNum* aabb = m.geom_aabb + 6 * g;
  const mjtNum *p = d.geom_xpos + 3 * g, *R = d.geom_xmat + 9 * g;
  float low[3], high[3];
  for (int i = 0; i < 3; ++i) {
    double c = p[i], half = 0;
    for (int k = 0; k < 3; ++k) {
      c += R[3 * i + k] * aabb[k];
      half += std::abs(R[3 * i + k]) * aabb[3 + k];
    }
    low[i] = static_cast<float>(c - half), high[i] = static_cast<float>(c + half);
  }
  extend(box, {low[0], low[1], low[2]}, {high[0], high[1], high[2]});
}

Vec3d position_of(const mjData& d, int body) {
  const mjtNum* p = d.xpos + 3 * body;
  return {p[0], p[1], p[2]};
}

// Height of a triangle at (x, y); false if the point is outside of it.
bool height_at(const Vec3f* t, double x, double y, double* z) {
  const double ax = double{t[0].x} - x, ay = double{t[0].y} - y, bx = double{t[1].x} - x,
               by = double{t[1].y} - y, cx = double{t[2].x} - x, cy = double{t[2].y} - y;
  const double u = bx * cy - by * cx, v = cx * ay - cy * ax, w = ax * by - ay * bx;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double sum = u + v + w;
  if (sum == 0) return false;
  *z = (u * double{t[0].z} + v * double{t[1].z} + w * double{t[2].z}) / sum;
  return true;
}

void look_for_ground(const ColliderSurface& s, Vec3d p, double most, double* best) {
  if (double{s.low.x} > p.x || double{s.high.x} < p.x || double{s.low.y} > p.y ||
      double{s.high.y} < p.y || double{s.high.z} <= *best)
    return;
  for (size_t i = 0; i + 2 < s.corners.size(); i += 3) {
    double z;
    if (height_at(s.corners.data() + i, p.x, p.y, &z) && z <= most && z > *best) *best = z;
  }
}

}  // namespace

bool is_door_leaf(const mjModel& m, const mjData& d, int body) {
  if (m.body_jntnum[body] != 1 || m.body_rootid[body] < 0) return false;
  const int joint = m.body_jntadr[body];
  if (m.jnt_type[joint] != mjJNT_HINGE || std::abs(d.xaxis[3 * joint + 2]) < 0.99) return false;
  for (int g = m.body_geomadr[body]; g < m.body_geomadr[body] + m.body_geomnum[body]; ++g)
    if (m.geom_type[g] == mjGEOM_BOX && can_collide(m, g) && m.geom_size[3 * g + 2] >= kLeastLeaf)
      return true;
  return false;
}

Result<std::unique_ptr<NavWorld>> NavWorld::create(const CompiledWorld& world, const mjModel& m,
                                                   const mjData& d) {
  std::unique_ptr<NavWorld> made(new NavWorld);
  for (const Region& room : world.regions) {
    const double area = (room.high.x - room.low.x) * (room.high.y - room.low.y);
    made->rooms_.push_back(room);
    made->room_areas_.push_back(area + (made->room_areas_.empty() ? 0 : made->room_areas_.back()));
  }
  made->find_bounds(world, m, d);
  made->sort_geoms(world, m, d);
  GLOAM_TRY_STATUS(made->make_meshes(world));
  return made;
}

// All that stands still; where a plane has no end, also what is around agents and their goals.
void NavWorld::find_bounds(const CompiledWorld& world, const mjModel& m, const mjData& d) {
  bounds_ = {{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}};
  bool has_plane = false;
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) {
    if (!can_collide(m, g) || m.body_weldid[m.geom_bodyid[g]] != 0) continue;
    if (m.geom_type[g] == mjGEOM_PLANE) {
      has_plane = true;
      const auto z = static_cast<float>(d.geom_xpos[3 * g + 2]);
      bounds_.low.z = min(bounds_.low.z, z), bounds_.high.z = max(bounds_.high.z, z);
    } else {
      bound_geom(m, d, g, &bounds_);
    }
  }
  const auto around = [&](const Vec3& p) {
    const auto reach = static_cast<float>(kPlaneMargin);
    const Vec3f at{static_cast<float>(p.x), static_cast<float>(p.y), 0};
    const NavBounds heights = bounds_;
    extend(&bounds_, {at.x - reach, at.y - reach, heights.low.z},
           {at.x + reach, at.y + reach, heights.high.z});
  };
  if (!has_plane) return;
  for (const AgentDescription& agent : world.agents) {
    around(agent.position);
    for (const WaypointOptions& point : agent.route) around(point.position);
  }
}

// A ground is cut into pieces, each with bounds of its own.
void NavWorld::add_still(ColliderSurface surface) {
  if (surface.corners.empty()) return;
  if (surface.is_solid || surface.corners.size() <= 3 * kChunk) {
    still_.push_back(std::move(surface));
    return;
  }
  for (size_t first = 0; first < surface.corners.size(); first += 3 * kChunk) {
    const size_t end = std::min(first + 3 * kChunk, surface.corners.size());
    ColliderSurface piece;
    piece.corners.assign(surface.corners.begin() + static_cast<ptrdiff_t>(first),
                         surface.corners.begin() + static_cast<ptrdiff_t>(end));
    NavBounds box{piece.corners[0], piece.corners[0]};
    for (const Vec3f v : piece.corners) extend(&box, v, v);
    piece.low = box.low, piece.high = box.high;
    still_.push_back(std::move(piece));
  }
}

void NavWorld::sort_geoms(const CompiledWorld& world, const mjModel& m, const mjData& d) {
  std::map<int, size_t> rows;  // rows of movables, by body
  std::vector<int> robot_of_root(static_cast<size_t>(m.nbody), -1);
  for (size_t i = 0; i < world.robots.size(); ++i)
    if (world.robots[i].root_body > 0)
      robot_of_root[static_cast<size_t>(world.robots[i].root_body)] = static_cast<int>(i);
  obstacle_of_robot_.assign(world.robots.size(), -1);
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) {
    if (!can_collide(m, g)) continue;
    const int body = m.geom_bodyid[g], weld = m.body_weldid[body];
    const int robot = robot_of_root[static_cast<size_t>(m.body_rootid[body])];
    if (weld == 0 && robot < 0) {
      add_still(collider_surface(m, g, d.geom_xpos + 3 * g, d.geom_xmat + 9 * g, bounds_));
      continue;
    }
    if (m.body_mocapid[weld] >= 0 || (robot < 0 && is_door_leaf(m, d, weld))) continue;
    const int key = robot >= 0 ? m.body_rootid[body] : weld;
    const auto [found, is_new] = rows.emplace(key, movables_.size());
    if (is_new) {
      Movable& movable = movables_.emplace_back();
      movable.body = key;
      movable.is_robot = robot >= 0;
      if (robot >= 0)
        obstacle_of_robot_[static_cast<size_t>(robot)] = static_cast<int>(found->second);
    }
    movables_[found->second].geoms.push_back(g);
  }
  obstacles_.resize(movables_.size());

  // Nothing to stand on has bounds that are none.
  const double across = std::ceil((bounds_.high.x - bounds_.low.x) / kSquare);
  const double along = std::ceil((bounds_.high.y - bounds_.low.y) / kSquare);
  if (!(bounds_.high.x > bounds_.low.x) || !(std::max(across, 1.0) * std::max(along, 1.0) <= 1e8))
    return;
  columns_ = std::max(1, static_cast<int>(across));
  rows_ = std::max(1, static_cast<int>(along));
  squares_.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
  for (size_t i = 0; i < still_.size(); ++i) {
    const auto square = [&](float p, float low, int count) {
      return std::clamp(static_cast<int>((p - low) / kSquare), 0, count - 1);
    };
    const int x0 = square(still_[i].low.x, bounds_.low.x, columns_),
              x1 = square(still_[i].high.x, bounds_.low.x, columns_),
              y0 = square(still_[i].low.y, bounds_.low.y, rows_),
              y1 = square(still_[i].high.y, bounds_.low.y, rows_);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        squares_[static_cast<size_t>(y * columns_ + x)].push_back(static_cast<int>(i));
  }
}

Status NavWorld::make_meshes(const CompiledWorld& world) {
  const NavigationOptions& o = world.scene.navigation;
  const auto placed = [&](Error error) {
    if (error.loc.line == 0) error.loc = o.loc.line > 0 ? o.loc : world.agents.front().loc;
    return error;
  };
  if (squares_.empty())
    return placed({ErrorKind::kInput,
                   "there is no ground for people and vehicles to stand on",
                   {},
                   "agents need static colliders below them"});
  for (const AgentDescription& agent : world.agents) {
    NavSettings settings{o.cell, agent.height, agent.radius, o.climb, o.slope, bounds_};
    if (agent.kind == AgentKind::kPerson) settings.headroom = o.headroom;
    size_t row = 0;
    while (row < meshes_.size() && !(settings_[row] == settings)) ++row;
    mesh_of_agent_.push_back(row);
    if (row < meshes_.size()) continue;
    Result<std::unique_ptr<NavMesh>> mesh = NavMesh::create(settings);
    if (!mesh.ok()) return placed(mesh.error());
    settings_.push_back(settings);
    meshes_.emplace_back().mesh = std::move(*mesh);
  }
  return {};
}

void NavWorld::collect(const NavBounds& reach, std::vector<const ColliderSurface*>* near) const {
  near->clear();
  for (const ColliderSurface& surface : still_)
    if (meet(reach, surface)) near->push_back(&surface);
  for (const Movable& movable : movables_)
    for (const ColliderSurface& surface : movable.surfaces)
      if (meet(reach, surface)) near->push_back(&surface);
}

void NavWorld::reset(const mjModel& m, const mjData& d) {
  for (Movable& movable : movables_) {
    movable.surfaces.clear();
    movable.is_in_mesh = false;
    movable.p = position_of(d, movable.body);
    movable.rest_time = 0;
    if (!movable.is_robot) put_into_mesh(m, d, &movable);
  }
  for (Mesh& mesh : meshes_) {
    const auto tiles = static_cast<size_t>(mesh.mesh->columns() * mesh.mesh->rows());
    mesh.dirty.assign(tiles, false);
    mesh.dirty_count = 0;
    if (mesh.is_initial) continue;
    if (mesh.initial.empty()) build_initial(&mesh);
    const bool is_empty = mesh.mesh->clear();
    GLOAM_CHECK(is_empty, "out of memory for the navigation mesh");
    for (size_t i = 0; i < tiles; ++i) {
      const int columns = mesh.mesh->columns();
      mesh.mesh->set_tile(static_cast<int>(i) % columns, static_cast<int>(i) / columns,
                          mesh.initial[i]);
    }
    mesh.mesh->find_parts();
    mesh.is_initial = true;
  }
  follow(m, d, 0);
}

void NavWorld::build_initial(Mesh* mesh) const {
  const int columns = mesh->mesh->columns();
  mesh->initial.resize(static_cast<size_t>(columns * mesh->mesh->rows()));
  parallel_for(
      "build the navigation mesh", static_cast<int64_t>(mesh->initial.size()), [&](int64_t i) {
        const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
        std::vector<const ColliderSurface*> near;
        collect(mesh->mesh->tile_reach(column, row), &near);
        mesh->initial[static_cast<size_t>(i)] = mesh->mesh->build_tile(column, row, near);
      });
}

void NavWorld::bound(const mjModel& m, const mjData& d, const Movable& movable,
                     NavBounds* box) const {
  *box = {{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}};
  for (const int g : movable.geoms) bound_geom(m, d, g, box);
}

void NavWorld::put_into_mesh(const mjModel& m, const mjData& d, Movable* movable) {
  movable->is_in_mesh = true;
  movable->p_in_mesh = position_of(d, movable->body);
  NavBounds box;
  bound(m, d, *movable, &box);
  const Vec3f size = box.high - box.low;
  if (max_component(size) < kMinObstacleEdge) return;
  for (const int g : movable->geoms) {
    movable->surfaces.push_back(
        collider_surface(m, g, d.geom_xpos + 3 * g, d.geom_xmat + 9 * g, bounds_));
    mark(movable->surfaces.back());
  }
}

void NavWorld::take_out_of_mesh(Movable* movable) {
  for (const ColliderSurface& surface : movable->surfaces) mark(surface);
  movable->surfaces.clear();
  movable->is_in_mesh = false;
  movable->rest_time = 0;
}

void NavWorld::mark(const ColliderSurface& surface) {
  for (Mesh& mesh : meshes_) {
    for (size_t i = 0; i < mesh.dirty.size(); ++i) {
      const int columns = mesh.mesh->columns();
      if (mesh.dirty[i] ||
          !meet(mesh.mesh->tile_reach(static_cast<int>(i) % columns, static_cast<int>(i) / columns),
                surface))
        continue;
      mesh.dirty[i] = true;
      ++mesh.dirty_count;
    }
  }
}

void NavWorld::rebuild(Mesh* mesh, size_t tile) const {
  const int columns = mesh->mesh->columns();
  const int column = static_cast<int>(tile) % columns, row = static_cast<int>(tile) / columns;
  std::vector<const ColliderSurface*> near;
  collect(mesh->mesh->tile_reach(column, row), &near);
  mesh->mesh->set_tile(column, row, mesh->mesh->build_tile(column, row, near));
}

bool NavWorld::rebuild_marked() {
  bool any = false;
  for (Mesh& mesh : meshes_) {
    if (mesh.dirty_count == 0) continue;
    const auto tile = static_cast<size_t>(std::find(mesh.dirty.begin(), mesh.dirty.end(), true) -
                                          mesh.dirty.begin());
    rebuild(&mesh, tile);
    mesh.dirty[tile] = false;
    mesh.is_initial = false;
    if (--mesh.dirty_count == 0) mesh.mesh->find_parts();
    any = true;
  }
  return any;
}

bool NavWorld::follow(const mjModel& m, const mjData& d, double dt) {
  for (size_t i = 0; i < movables_.size(); ++i) {
    Movable& movable = movables_[i];
    NavObstacle& obstacle = obstacles_[i];
    const Vec3d p = position_of(d, movable.body);
    const Vec3d velocity = dt > 0 ? (p - movable.p) * (1 / dt) : Vec3d{};
    if (movable.is_in_mesh && norm(p - movable.p_in_mesh) > kDisplacedDistance)
      take_out_of_mesh(&movable);
    movable.rest_time = norm(velocity) > kMovingSpeed ? 0 : movable.rest_time + dt;
    if (!movable.is_in_mesh && movable.rest_time > (movable.is_robot ? kRobotRestTime : kRestTime))
      put_into_mesh(m, d, &movable);
    const bool is_known = movable.is_in_mesh && !movable.is_robot && obstacle.radius > 0;
    movable.p = p;
    obstacle.velocity = velocity;
    obstacle.is_in_mesh = movable.is_in_mesh;
    if (is_known) continue;
    NavBounds box;
    bound(m, d, movable, &box);
    const Vec3f middle = (box.low + box.high) * 0.5f, size = box.high - box.low;
    obstacle.p = {double{middle.x}, double{middle.y}, double{box.low.z}};
    obstacle.radius = 0.5 * double{max(size.x, size.y)};
    obstacle.is_robot = movable.is_robot;
    if (max_component(size) < kMinObstacleEdge) obstacle.is_in_mesh = true;  // in nobody's way
  }
  return rebuild_marked();
}

double NavWorld::ground_below(Vec3d p, double up, double down) const {
  const double most = p.z + up;
  double best = p.z - down;
  const double least = best;
  const int x = static_cast<int>(std::floor((p.x - double{bounds_.low.x}) / double{kSquare})),
            y = static_cast<int>(std::floor((p.y - double{bounds_.low.y}) / double{kSquare}));
  if (x >= 0 && y >= 0 && x < columns_ && y < rows_) {
    for (const int i : squares_[static_cast<size_t>(y * columns_ + x)])
      look_for_ground(still_[static_cast<size_t>(i)], p, most, &best);
  }
  for (const Movable& movable : movables_)
    for (const ColliderSurface& surface : movable.surfaces)
      look_for_ground(surface, p, most, &best);
  return best > least ? best : p.z;
}

NavPoint NavWorld::random_place(size_t agent, const NavPoint& from, double u, double v,
                                double w) const {
  const NavMesh& mesh = mesh_of(agent);
  if (rooms_.empty()) return mesh.random_point(from, u, v, w);
  const auto row =
      std::upper_bound(room_areas_.begin(), room_areas_.end() - 1, u * room_areas_.back()) -
      room_areas_.begin();
  const Region& room = rooms_[static_cast<size_t>(row)];
  const NavPoint at = mesh.nearest({room.low.x + v * (room.high.x - room.low.x),
                                    room.low.y + w * (room.high.y - room.low.y), room.low.z},
                                   0.3, 0.3);
  if (at.ref == 0 || mesh.area_around(at) < kLeastPart) return {};
  return from.ref == 0 || mesh.are_connected(from, at) ? at : NavPoint{};
}

uint64_t NavWorld::hash(uint64_t seed) const {
  for (const Movable& movable : movables_) {
    const double state[5] = {movable.rest_time, movable.is_in_mesh ? 1.0 : 0.0, movable.p_in_mesh.x,
                             movable.p_in_mesh.y, movable.p_in_mesh.z};
    seed = hash_bytes(state, sizeof(state), seed);
  }
  for (const Mesh& mesh : meshes_) seed = hash_bytes(&mesh.dirty_count, sizeof(size_t), seed);
  return seed;
}

}  // namespace gloam

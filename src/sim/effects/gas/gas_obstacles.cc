#include "sim/effects/gas/gas_obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "gloam/command.h"
#include "scene/files/mujoco_guard.h"
#include "sim/commands/live_fields.h"
#include "world/model_memory.h"
#include "world/shapes/visual_pose.h"

namespace gloam {
namespace {

constexpr double kMostWallCells = double{1 << 28};  // 4 GiB of walls

Status check_grid(const GasGrid& g, double sealed_gap) {
  const bool sized = g.voxel > 0 && std::isfinite(g.voxel) && std::isfinite(g.low.x) &&
                     std::isfinite(g.low.y) && std::isfinite(g.low.z);
  if (g.nx < 1 || g.ny < 1 || g.nz < 1 || !sized) {
    return Error{ErrorKind::kUsage, fmt::format("a gas cannot have {} x {} x {} cells of {} m",
                                                g.nx, g.ny, g.nz, g.voxel)};
  }
  if (!(sealed_gap >= 0 && std::isfinite(sealed_gap))) {
    return Error{ErrorKind::kUsage,
                 fmt::format("gaps narrower than {} m cannot be sealed", sealed_gap)};
  }
  if (double(g.nx) * g.ny * g.nz > kMostWallCells) {
    return Error{
        ErrorKind::kUsage,
        fmt::format("a gas of {} x {} x {} cells is too large", g.nx, g.ny, g.nz),
        {},
        fmt::format("use larger voxels or a smaller domain: at most {:.0f} cells", kMostWallCells)};
  }
  return {};
}

// All open, without velocities.
void open_masks(const GasGrid& g, GasWalls* walls) {
  const auto n = [](int x, int y, int z) {
    return static_cast<size_t>(x) * static_cast<size_t>(y) * static_cast<size_t>(z);
  };
  walls->grid = g;
  walls->closed[0].assign(n(g.nx + 1, g.ny, g.nz), 0);
  walls->closed[1].assign(n(g.nx, g.ny + 1, g.nz), 0);
  walls->closed[2].assign(n(g.nx, g.ny, g.nz + 1), 0);
  walls->solid.assign(n(g.nx, g.ny, g.nz), 0);
}

bool same_shape(const GasWalls& a, const GasWalls& b) {
  const GasGrid &g = a.grid, &h = b.grid;
  bool same = g.nx == h.nx && g.ny == h.ny && g.nz == h.nz && g.voxel == h.voxel &&
              g.low == h.low && a.solid.size() == b.solid.size();
  for (int axis = 0; axis < 3; ++axis)
    same = same && a.closed[axis].size() == b.closed[axis].size() &&
           a.velocity[axis].size() == b.closed[axis].size();
  return same;
}

}  // namespace

GasObstacles::GasObstacles(std::shared_ptr<const CompiledWorld> world, const GasGrid& grid,
                           double sealed_gap)
    : world_(std::move(world)), model_(*world_->model), grid_(grid), lines_(grid, sealed_gap) {
  model_.opt.enableflags &= ~mjENBL_SLEEP;  // kinematics skips what sleeps
}

Result<std::unique_ptr<GasObstacles>> GasObstacles::create(
    std::shared_ptr<const CompiledWorld> world, const GasGrid& grid, double sealed_gap) {
  GLOAM_TRY_STATUS(check_grid(grid, sealed_gap));
  std::unique_ptr<GasObstacles> made(new GasObstacles(std::move(world), grid, sealed_gap));
  made->data_ = make_data(made->model_);
  mjData* data = made->data_.get();
  GLOAM_TRY_STATUS(guarded([&] { mj_kinematics(&made->model_, data); }));
  made->sort_geoms();
  made->voxelise_still();
  return made;
}

void GasObstacles::sort_geoms() {
  const mjModel& m = model_;
  std::vector<bool> collide = colliders(m);
  for (const RotorDescription& rotor : world_->gases.rotors)
    for (const int blade : rotor.blades) collide[static_cast<size_t>(blade)] = false;
  hulls_.resize(static_cast<size_t>(m.nmesh));
  size_t most_runs = 0;
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) {
    if (!collide[static_cast<size_t>(g)]) continue;
    const int type = m.geom_type[g];
    if (type == mjGEOM_SDF) {
      ++left_out_;
    } else if (type == mjGEOM_HFIELD) {  // MuJoCo allows it on bodies that stand still only
      height_geoms_.push_back(g);
    } else if (m.body_weldid[m.geom_bodyid[g]] == 0) {
      still_geoms_.push_back(g);
    } else {
      moving_geoms_.push_back(g);
      most_runs += lines_.most_runs(m.geom_rbound[g]);
    }
    if (type != mjGEOM_MESH) continue;
    std::vector<SolidPlane>& hull = hulls_[static_cast<size_t>(m.geom_dataid[g])];
    if (hull.empty()) hull = hull_planes(m, m.geom_dataid[g]);
  }
  for (int f = 0; f < static_cast<int>(m.nflex); ++f)
    if (m.flex_contype[f] != 0 || m.flex_conaffinity[f] != 0) ++left_out_;
  for (auto* runs : {&runs_, &runs_before_}) runs->reserve(most_runs);
  for (auto* movers : {&movers_, &movers_before_}) movers->reserve(moving_geoms_.size());
}

void GasObstacles::add_runs(int g) {
  const mjModel& m = model_;
  solid_.set_pose(grid_, data_->geom_xpos + 3 * g, data_->geom_xmat + 9 * g);
  if (m.geom_type[g] == mjGEOM_MESH) {
    const mjtNum* box = m.geom_aabb + 6 * g;  // centre, half sides
    solid_.make_polyhedron(hulls_[static_cast<size_t>(m.geom_dataid[g])], box, box + 3);
  } else if (!solid_.make_primitive(m.geom_type[g], m.geom_size + 3 * g)) {
    return;
  }
  lines_.append(solid_, &runs_);
}

// A bed is as deep in each column of voxels as in its middle, as it lies at time 0.
void GasObstacles::voxelise_soil(const SoilDescription& soil) {
  const mjtNum upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int j = 0; j < grid_.ny; ++j) {
    runs_.clear();
    for (int i = 0; i < grid_.nx; ++i) {
      const double x = grid_.low.x + (i + 0.5) * grid_.voxel;
      const double y = grid_.low.y + (j + 0.5) * grid_.voxel;
      const double column = std::floor((x - soil.low_x()) / soil.dx);
      const double row = std::floor((y - soil.low_y()) / soil.dy);
      if (!(column >= 0 && column < soil.nx && row >= 0 && row < soil.ny)) continue;
      const auto cell = static_cast<size_t>(row * soil.nx + column);
      const double depth = soil.depth_of(cell, 0);
      if (!(depth > 0)) continue;
      const mjtNum p[3] = {x, y, soil.rest_of(cell) - depth / 2};
      const mjtNum half[3] = {grid_.voxel / 2, grid_.voxel / 2, depth / 2};
      solid_.set_pose(grid_, p, upright);
      if (solid_.make_primitive(mjGEOM_BOX, half)) lines_.append(solid_, &runs_);
    }
    lines_.close(runs_, &still_);
  }
}

void GasObstacles::voxelise_still() {
  open_masks(grid_, &still_);
  for (const int g : still_geoms_) {
    runs_.clear();
    add_runs(g);
    lines_.close(runs_, &still_);
  }
  for (const SoilDescription& soil : world_->soils) voxelise_soil(soil);
  runs_.clear();
  if (height_geoms_.empty()) return;
  fixed_ = still_;
  voxelise_height_fields(model_.hfield_data);
}

void GasObstacles::voxelise_height_fields(const float* data) {
  still_ = fixed_;
  for (const int g : height_geoms_) {
    solid_.set_pose(grid_, data_->geom_xpos + 3 * g, data_->geom_xmat + 9 * g);
    const HeightFieldPrisms field(model_, model_.geom_dataid[g], data);
    for (int row = 0; row + 1 < field.rows(); ++row) {
      runs_.clear();
      for (int column = 0; column + 1 < field.columns(); ++column) {
        for (const bool second : {false, true}) {
          field.make_prism(column, row, second, &solid_);
          lines_.append(solid_, &runs_);
        }
      }
      lines_.close(runs_, &still_);
    }
  }
  runs_.clear();
}

// True where the ground is another than at the last call.
bool GasObstacles::follow_height_fields(const LiveFields* live) {
  const uint64_t serial = live != nullptr ? live->height_field_serial : 0;
  if (serial == height_serial_ || height_geoms_.empty()) return false;
  height_serial_ = serial;
  std::vector<float> heights;
  live_field_at(model_, serial != 0 ? live : nullptr, LiveFieldId::kHeightField, &heights);
  voxelise_height_fields(heights.data());
  return true;
}

// Velocity of a mocap body since the last instant: MuJoCo has none.
void GasObstacles::follow_mocap(const SnapshotData& in) {
  const double dt = in.time - mocap_time_;
  const bool goes_on = in.run == mocap_run_ && dt > 0;
  if (in.run == mocap_run_ && dt == 0) return;
  mocaps_.resize(static_cast<size_t>(model_.nmocap));
  for (int body = 1; body < static_cast<int>(model_.nbody); ++body) {
    if (model_.body_mocapid[body] < 0) continue;
    Mocap& mocap = mocaps_[static_cast<size_t>(model_.body_mocapid[body])];
    const mjtNum *p = data_->xpos + 3 * body, *q = data_->xquat + 4 * body;
    mocap.motion = {};
    if (goes_on) {
      mjtNum turned[3], moved[3];
      mju_subQuat(turned, q, mocap.q);  // in the axes of before
      mju_rotVecQuat(mocap.motion.w, turned, mocap.q);
      mju_scl3(mocap.motion.w, mocap.motion.w, 1 / dt);
      mju_sub3(moved, p, mocap.p);
      mju_scl3(moved, moved, 1 / dt);
      const double to_low[3] = {grid_.low.x - p[0], grid_.low.y - p[1], grid_.low.z - p[2]};
      mju_cross(mocap.motion.v, mocap.motion.w, to_low);
      mju_addTo3(mocap.motion.v, moved);
      if (mju_norm3(moved) > kTeleport) mocap.motion = {};
    }
    mju_copy3(mocap.p, p);
    mju_copy4(mocap.q, q);
  }
  mocap_run_ = in.run, mocap_time_ = in.time;
}

// Velocities do not depend on masses, so no live field matters here but height fields.
RigidMotion GasObstacles::motion_of(int body) const {
  mjtNum velocity[6];  // angular, linear at xpos
  mj_objectVelocity(&model_, data_.get(), mjOBJ_XBODY, body, velocity, 0);
  const mjtNum* p = data_->xpos + 3 * body;
  const double to_low[3] = {grid_.low.x - p[0], grid_.low.y - p[1], grid_.low.z - p[2]};
  RigidMotion motion;
  mju_copy3(motion.w, velocity);
  mju_cross(motion.v, motion.w, to_low);
  mju_addTo3(motion.v, velocity + 3);
  if (const int mocap = model_.body_mocapid[model_.body_rootid[body]]; mocap >= 0) {
    const RigidMotion& base = mocaps_[static_cast<size_t>(mocap)].motion;
    mju_addTo3(motion.v, base.v);
    mju_addTo3(motion.w, base.w);
  }
  return motion;
}

void GasObstacles::voxelise_movers() {
  runs_.swap(runs_before_);
  movers_.swap(movers_before_);
  runs_.clear();
  movers_.clear();
  for (const int g : moving_geoms_) {
    const size_t first = runs_.size();
    add_runs(g);
    if (runs_.size() == first) continue;  // beside the grid, or between its lines
    movers_.push_back({g, runs_.size(), motion_of(model_.geom_bodyid[g])});
  }
}

void GasObstacles::write(bool anew, GasWalls* walls) {
  if (anew) {
    walls->grid = grid_;
    walls->solid = still_.solid;
    for (int axis = 0; axis < 3; ++axis) {
      walls->closed[axis] = still_.closed[axis];
      walls->velocity[axis].assign(still_.closed[axis].size(), 0);
    }
  } else if (shape_changed_) {
    lines_.restore(runs_before_, still_, walls);
  } else if (!changed_) {
    return;
  }
  size_t first = 0;
  for (const Mover& mover : movers_) {
    lines_.close(std::span(runs_).subspan(first, mover.end - first), mover.motion, still_, walls);
    first = mover.end;
  }
}

Status GasObstacles::solve(const Snapshot& snapshot, GasWalls* walls) {
  const SnapshotData& in = snapshot.data();
  GLOAM_CHECK(in.world == world_, "the Snapshot belongs to another World");
  GLOAM_CHECK(walls != nullptr, "'walls' must not be null");
  GLOAM_TRY_STATUS(guarded([&] {
    mj_setState(&model_, data_.get(), in.state.data(), mjSTATE_INTEGRATION);
    mj_kinematics(&model_, data_.get());
    mj_comPos(&model_, data_.get());
    mj_comVel(&model_, data_.get());
  }));
  const bool new_ground = follow_height_fields(in.live.get());
  follow_mocap(in);
  voxelise_movers();
  const bool first = filled_ == nullptr;
  shape_changed_ = first || new_ground || runs_ != runs_before_;
  changed_ = shape_changed_ || movers_ != movers_before_;
  write(walls != filled_ || new_ground || !same_shape(*walls, still_), walls);
  filled_ = walls;
  return {};
}

Affine3f GasObstacles::X_WB(int body) const {
  return rigid_pose(data_->xpos + 3 * body, data_->xquat + 4 * body);
}

}  // namespace gloam

#include "gas_rig.h"

#include <algorithm>

#include "sim/snapshots/snapshot.h"

namespace gloam {

size_t gas_index(const GasGrid& g, int axis, int i, int j, int k) {
  const int nx = g.nx + (axis == 0), ny = g.ny + (axis == 1);
  return (static_cast<size_t>(k) * static_cast<size_t>(ny) + static_cast<size_t>(j)) *
             static_cast<size_t>(nx) +
         static_cast<size_t>(i);
}

std::array<double, 3> gas_centre(const GasGrid& g, int axis, int i, int j, int k) {
  const double voxel = g.voxel, low[3] = {g.low.x, g.low.y, g.low.z};
  const int at[3] = {i, j, k};
  std::array<double, 3> p{};
  for (int a = 0; a < 3; ++a)
    p[static_cast<size_t>(a)] = low[a] + voxel * (at[a] + (a == axis ? 0 : 0.5));
  return p;
}

void flood(const GasWalls& walls, std::vector<uint8_t>* reached) {
  const GasGrid& g = walls.grid;
  const int n[3] = {g.nx, g.ny, g.nz};
  std::vector<std::array<int, 3>> open;
  for_cells(g, [&](int i, int j, int k, size_t at) {
    if ((*reached)[at]) open.push_back({i, j, k});
  });
  while (!open.empty()) {
    const std::array<int, 3> from = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        std::array<int, 3> face = from, to = from;
        face[static_cast<size_t>(axis)] += step == 1 ? 1 : 0;
        to[static_cast<size_t>(axis)] += step;
        const int x = to[static_cast<size_t>(axis)];
        if (x < 0 || x >= n[axis]) continue;
        if (walls.closed[axis][gas_index(g, axis, face[0], face[1], face[2])]) continue;
        uint8_t& seen = (*reached)[gas_index(g, 3, to[0], to[1], to[2])];
        if (!seen) open.push_back(to);
        seen = 1;
      }
    }
  }
}

void expect_consistent(const GasWalls& walls) {
  const GasGrid& g = walls.grid;
  ASSERT_EQ(walls.solid.size(), size_t(g.nx) * size_t(g.ny) * size_t(g.nz));
  for (int axis = 0; axis < 3; ++axis) {
    ASSERT_EQ(walls.closed[axis].size(), gas_index(g, axis, 0, 0, g.nz + (axis == 2)));
    ASSERT_EQ(walls.velocity[axis].size(), walls.closed[axis].size());
  }
  int open_faces_of_solids = 0, moving_air = 0;
  for_cells(g, [&](int i, int j, int k, size_t at) {
    if (!walls.solid[at]) return;
    for (int side = 0; side < 2; ++side) {
      open_faces_of_solids += !walls.closed[0][gas_index(g, 0, i + side, j, k)];
      open_faces_of_solids += !walls.closed[1][gas_index(g, 1, i, j + side, k)];
      open_faces_of_solids += !walls.closed[2][gas_index(g, 2, i, j, k + side)];
    }
  });
  for_faces(g, [&](int axis, int, int, int, size_t at) {
    moving_air += !walls.closed[axis][at] && walls.velocity[axis][at] != 0;
  });
  EXPECT_EQ(open_faces_of_solids, 0);
  EXPECT_EQ(moving_air, 0);
}

void expect_equal(const GasWalls& a, const GasWalls& b) {
  EXPECT_TRUE(a.solid == b.solid);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(a.closed[axis] == b.closed[axis]) << "axis " << axis;
    EXPECT_TRUE(a.velocity[axis] == b.velocity[axis]) << "axis " << axis;
  }
}

int count(const std::vector<uint8_t>& flags) {
  return static_cast<int>(std::count(flags.begin(), flags.end(), uint8_t{1}));
}

GasRig::GasRig(std::shared_ptr<CompiledWorld> made, const GasGrid& grid, double sealed_gap)
    : world(std::move(made)), d(mj_makeData(world->model.get())), gap(sealed_gap) {
  auto result = GasObstacles::create(world, grid, gap);
  if (!result.ok()) {
    ADD_FAILURE() << result.error().to_string();
    abort();
  }
  obstacles = std::move(*result);
}

GasRig::GasRig(const std::string& bodies, const GasGrid& grid, double sealed_gap)
    : GasRig(world_from_mjcf("<mujoco><worldbody>" + bodies + "</worldbody></mujoco>"), grid,
             sealed_gap) {}

Snapshot GasRig::snapshot() const {
  auto data = std::make_shared<SnapshotData>();
  data->world = world;
  data->time = d->time;
  const mjModel* m = world->model.get();
  data->state.resize(static_cast<size_t>(mj_stateSize(m, mjSTATE_INTEGRATION)));
  mj_getState(m, d.get(), data->state.data(), mjSTATE_INTEGRATION);
  return Snapshot(std::move(data));
}

void GasRig::solve() {
  const Status status = obstacles->solve(snapshot(), &walls);
  ASSERT_TRUE(status.ok()) << status.error().to_string();
  expect_consistent(walls);
}

GasWalls GasRig::fresh() const {
  GasWalls made;
  auto other = *GasObstacles::create(world, walls.grid, gap);
  EXPECT_TRUE(other->solve(snapshot(), &made).ok());
  return made;
}

}  // namespace gloam

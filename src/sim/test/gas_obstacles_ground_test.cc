// Ground that a gas meets, against MuJoCo's own rays; and ground that changes.

#include <fmt/format.h>

#include <cmath>

#include "gas_rig.h"

namespace gloam {
namespace {

// As a box of its size is.
TEST(GasObstacles, BedsOfSoilAreSolid) {
  const GasGrid grid = cube_grid(16, .1f);
  auto world = world_from_mjcf("<mujoco/>");
  SoilDescription& soil = world->soils.emplace_back();
  soil.x = 0.1, soil.y = -0.2, soil.size_x = 0.8, soil.size_y = 0.6, soil.nx = 40, soil.ny = 30;
  soil.dx = soil.dy = 0.02, soil.level = 0.12, soil.depth = 0.3;
  GasRig bed(world, grid), box("<geom type='box' pos='.1 -.2 -.03' size='.4 .3 .15'/>", grid);
  bed.solve(), box.solve();
  expect_consistent(bed.walls);
  EXPECT_GT(count(bed.walls.solid), 100);
  expect_equal(bed.walls, box.walls);
  // Rises along x, and is bare at y > -0.2.
  for (int cell = 0; cell < 40 * 30; ++cell) {
    soil.rest.push_back(0.12f + 0.01f * static_cast<float>(cell % 40));
    soil.share.push_back(cell < 40 * 15 ? 1 : 0);
  }
  GasRig slope(world, grid);
  slope.solve();
  for_cells(grid, [&](int i, int j, int k, size_t at) {
    const auto p = gas_centre(grid, 3, i, j, k);
    const double x = p[0] + 0.3, y = p[1] + 0.5;  // in the bed
    const double top = 0.12 + 0.01 * std::floor(x / 0.02);
    const bool in = x > 0 && x < 0.8 && y > 0 && y < 0.3 && p[2] < top && p[2] > top - 0.3;
    EXPECT_EQ(in, slope.walls.solid[at] != 0) << p[0] << " " << p[1] << " " << p[2];
  });
}

TEST(GasObstacles, HeightFieldsAreSolidUnderTheSurfaceThatMuJoCoHas) {
  std::string elevation;
  for (int i = 0; i < 7 * 9; ++i) elevation += fmt::format("{} ", .5 + .5 * random_control(7, i));
  auto world = world_from_mjcf(
      fmt::format("<mujoco><asset><hfield name='h' nrow='7' ncol='9' size='.9 .7 .6 .3' "
                  "elevation='{}'/></asset>"
                  "<worldbody><geom type='hfield' hfield='h' pos='.02 .03 -.2' euler='0 0 30'/>"
                  "<body pos='0 0 5'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
                  elevation));
  const mjModel& m = *world->model;
  auto sim = make_simulator(world, lockstep());
  sim->start();
  GasRig rig(world, cube_grid(24, .1f));
  DataPtr d(mj_makeData(&m));
  const Snapshot before = sim->latest();
  const auto expect_ground = [&](const Snapshot& s) {
    ASSERT_TRUE(rig.obstacles->solve(s, &rig.walls).ok());
    expect_consistent(rig.walls);
    mj_kinematics(&m, d.get());
    int solid = 0, wrong = 0, open = 0;
    const GasGrid& g = rig.walls.grid;
    const mjtNum down[3] = {0, 0, -1};
    for_cells(g, [&](int i, int j, int k, size_t at) {
      auto p = gas_centre(g, 3, i, j, k);
      const double z = p[2];
      p[2] = 3;
      const double top = 3 - mj_rayHfield(&m, d.get(), 0, p.data(), down, nullptr);
      if (std::abs(top - z) < 1e-4) return;
      const bool in = top < 3.5 && z < top && z > -.5;
      solid += in;
      wrong += in != (rig.walls.solid[at] != 0);
      // Between this cell and the one above.
      if (top < 3.5 && z < top && z > -.5 - .1)
        open += !rig.walls.closed[2][gas_index(g, 2, i, j, k + 1)];
    });
    EXPECT_GT(solid, 300);
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(open, 0);
  };
  expect_ground(before);
  const GasWalls first = rig.walls;
  SetLiveField flat{LiveFieldId::kHeightField, 0, std::vector<double>(7 * 9, .9)};
  ASSERT_TRUE(sim->post({.what = flat}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  std::fill(m.hfield_data, m.hfield_data + 7 * 9, .9f);  // for mj_ray
  expect_ground(sim->latest());
  EXPECT_TRUE(rig.obstacles->shape_changed());
  EXPECT_FALSE(rig.walls.solid == first.solid);
}

}  // namespace
}  // namespace gloam

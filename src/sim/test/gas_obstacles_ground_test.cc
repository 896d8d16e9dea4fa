// Ground that a gas meets, against MuJoCo's own rays; and ground that changes.

#include <fmt/format.h>

#include <cmath>

#include "gas_rig.h"

namespace gloam {
namespace {

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
  SetLiveField flat{LiveFieldId::kHeightField, 0, std::vector<float>(7 * 9, .9f)};
  ASSERT_TRUE(sim->post({.what = flat}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  std::fill(m.hfield_data, m.hfield_data + 7 * 9, .9f);  // for mj_ray
  expect_ground(sim->latest());
  EXPECT_TRUE(rig.obstacles->shape_changed());
  EXPECT_FALSE(rig.walls.solid == first.solid);
}

}  // namespace
}  // namespace gloam

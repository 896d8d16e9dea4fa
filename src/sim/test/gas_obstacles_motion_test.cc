// What moves, changes and is asked for again: velocities of faces, walls that open, ground.

#include <fmt/format.h>

#include <cmath>

#include "base/parallel.h"
#include "gas_rig.h"

namespace gloam {
namespace {

const char* const kTumbler =
    "<body name='t' pos='.02 .01 -.03' quat='.8 .3 -.2 .4'><freejoint/>"
    "<geom type='{}' pos='.1 .05 0'/></body>";

std::string tumbler(const char* shape) {
  return fmt::format(fmt::runtime(kTumbler), std::string(shape));
}

void spin(GasRig& rig) {
  const double qvel[6] = {.4, -.7, .3, 2, -1, 3};  // linear: world; angular: the body's own axes
  std::copy(qvel, qvel + 6, rig.d->qvel);
}

TEST(GasObstacles, FacesMoveWithTheBody) {
  for (const char* shape : {"sphere' size='.4", "box' size='.4 .3 .02", "capsule' size='.2 .3"}) {
    SCOPED_TRACE(shape);
    GasRig rig(tumbler(shape), cube_grid(16, .1f));
    spin(rig);
    rig.solve();
    mj_kinematics(rig.world->model.get(), rig.d.get());
    mjtNum w[3];
    mju_mulMatVec3(w, rig.d->xmat + 9, rig.d->qvel + 3);
    int closed = 0;
    double worst = 0;
    for_faces(rig.walls.grid, [&](int axis, int i, int j, int k, size_t at) {
      if (!rig.walls.closed[axis][at]) return;
      ++closed;
      mjtNum r[3], v[3];
      mju_sub3(r, gas_centre(rig.walls.grid, axis, i, j, k).data(), rig.d->qpos);
      mju_cross(v, w, r);
      const double expected = v[axis] + rig.d->qvel[axis];
      worst = std::max(worst, std::abs(expected - double{rig.walls.velocity[axis][at]}));
    });
    EXPECT_GT(closed, 50);
    EXPECT_LT(worst, 1e-6);
  }
}

// A plate that is led by hand, and what hangs on it, half a second on its way; then put elsewhere.
TEST(GasObstacles, FacesMoveWithAMocapBody) {
  GasRig rig(
      "<body name='hand' mocap='true'><geom type='box' size='.05 .4 .4'/>"
      "<body pos='.2 0 0'><joint type='slide' axis='0 1 0'/><geom size='.1' "
      "mass='1'/></body></body>",
      cube_grid(16, .1f));
  const auto fastest = [&] {
    double least = 0, most = 0;
    for (const float v : rig.walls.velocity[0])
      least = std::min(least, double(v)), most = std::max(most, double(v));
    return std::pair(least, most);
  };
  rig.solve();
  EXPECT_EQ(fastest(), std::pair(0.0, 0.0)) << "nothing was before";
  rig.d->time = 0.5;
  rig.d->mocap_pos[0] = 0.1;
  rig.d->mocap_quat[0] = std::cos(0.05), rig.d->mocap_quat[3] = std::sin(0.05);  // 0.1 rad about z
  rig.d->qvel[0] = 0.3;
  rig.solve();
  expect_consistent(rig.walls);
  int plate = 0;
  double worst = 0;
  for_faces(rig.walls.grid, [&](int axis, int i, int j, int k, size_t at) {
    if (!rig.walls.closed[axis][at] || axis == 1) return;
    const auto p = gas_centre(rig.walls.grid, axis, i, j, k);
    // 0.2 m/s along x, 0.2 rad/s about z, around the body's origin at (0.1, 0, 0).
    const double expected = axis == 0 ? 0.2 - 0.2 * p[1] : 0;
    const double slide = axis == 0 ? -0.3 * std::sin(0.1) : 0;  // of the ball, along the turned y
    const double v = rig.walls.velocity[axis][at];
    worst = std::max(worst, std::min(std::abs(v - expected), std::abs(v - expected - slide)));
    plate += axis == 0;
  });
  EXPECT_GT(plate, 50);
  EXPECT_LT(worst, 1e-6);
  rig.solve();  // of the same instant: the same
  EXPECT_FALSE(rig.obstacles->changed());
  EXPECT_GT(fastest().second, 0.1);
  rig.d->time = 0.6;
  rig.d->mocap_pos[0] = -5;
  rig.solve();
  rig.d->time = 0.7;
  rig.d->mocap_pos[0] = 0;
  rig.d->qvel[0] = 0;
  rig.solve();
  EXPECT_EQ(fastest(), std::pair(0.0, 0.0)) << "50 m/s is no motion";
}

// A rigid body takes no more room for its moving: what its faces push out they draw in.
TEST(GasObstacles, NoNetFluxThroughTheSurfaceOfABody) {
  for (const char* shape : {"sphere' size='.4", "box' size='.4 .3 .2", "cylinder' size='.3 .4"}) {
    GasRig rig(tumbler(shape), cube_grid(16, .1f));
    spin(rig);
    rig.solve();
    const GasWalls& w = rig.walls;
    const GasGrid& g = w.grid;
    double flux = 0, both_ways = 0;  // out of solid cells, out of all that air does not reach
    for (const bool sealed : {false, true}) {
      std::vector<uint8_t> outside(w.solid.size());
      outside[0] = 1;
      flood(w, &outside);
      const auto is_in = [&](int i, int j, int k) {
        if (std::min({i, j, k}) < 0 || i >= g.nx || j >= g.ny || k >= g.nz) return false;
        const size_t at = gas_index(g, 3, i, j, k);
        return sealed ? !outside[at] : w.solid[at] != 0;
      };
      for_faces(g, [&](int axis, int i, int j, int k, size_t at) {
        const bool high = is_in(i, j, k),
                   low = is_in(i - (axis == 0), j - (axis == 1), k - (axis == 2));
        if (high == low) return;
        const double v = double{w.velocity[axis][at]};
        flux += low ? v : -v;
        both_ways += std::abs(v);
      });
    }
    EXPECT_GT(both_ways, 10) << shape;
    EXPECT_LT(std::abs(flux), 1e-12 * both_ways) << shape;
  }
}

TEST(GasObstacles, WhatMovesAwayOpensItsFacesAgain) {
  GasRig rig(
      "<geom type='plane' size='1 1 .1' pos='0 0 -.52'/>"
      "<geom type='box' size='.02 .8 .8' pos='.2 0 0' euler='0 0 20'/>"
      "<body name='a'><freejoint/><geom type='sphere' size='.3'/>"
      "<geom type='box' size='.4 .01 .4' euler='10 20 30'/></body>"
      "<body name='b' mocap='true' pos='-.3 0 0'><geom type='capsule' size='.1 .3'/></body>",
      cube_grid(16, .1f));
  rig.solve();
  EXPECT_TRUE(rig.obstacles->changed());
  EXPECT_TRUE(rig.obstacles->shape_changed());
  rig.solve();
  EXPECT_FALSE(rig.obstacles->changed());
  rig.d->qvel[1] = .5;
  rig.solve();
  EXPECT_TRUE(rig.obstacles->changed());
  EXPECT_FALSE(rig.obstacles->shape_changed());
  expect_equal(rig.walls, rig.fresh());
  for (int step = 0; step < 12; ++step) {
    SCOPED_TRACE(step);
    for (int i = 0; i < 3; ++i) {
      rig.d->qpos[i] = random_control(step, i);
      rig.d->qvel[3 + i] = random_control(step, 3 + i);
      rig.d->mocap_pos[i] = random_control(step, 6 + i);
    }
    GasWalls other;  // in between, another object is filled
    if (step % 4 == 3) {
      ASSERT_TRUE(rig.obstacles->solve(rig.snapshot(), &other).ok());
    }
    rig.solve();
    EXPECT_EQ(rig.obstacles->changed(), step % 4 != 3);
    expect_equal(rig.walls, rig.fresh());
  }
  rig.d->qpos[0] = rig.d->mocap_pos[0] = 100;
  rig.solve();
  GasRig still(
      "<geom type='plane' size='1 1 .1' pos='0 0 -.52'/>"
      "<geom type='box' size='.02 .8 .8' pos='.2 0 0' euler='0 0 20'/>",
      cube_grid(16, .1f));
  still.solve();
  expect_equal(rig.walls, still.walls);
  EXPECT_GT(count(still.walls.closed[0]), 100);
}

// The gas is not drawn through a wall that something moves at.
TEST(GasObstacles, AWallStandsStillWhateverMovesIntoIt) {
  GasRig rig(
      "<body><freejoint/><geom type='box' size='.3 .3 .3'/></body>"
      "<geom type='box' size='.01 1 1'/>",
      cube_grid(10, .1f));
  rig.d->qvel[0] = 1;
  rig.solve();
  const GasGrid& g = rig.walls.grid;
  EXPECT_EQ(rig.walls.velocity[0][gas_index(g, 0, 5, 5, 5)], 0);
  EXPECT_NEAR(double{rig.walls.velocity[0][gas_index(g, 0, 4, 5, 5)]}, 1, 1e-6);
}

TEST(GasObstacles, OnlyWhatCanCollideIsMet) {
  const std::string shape = "type='sphere' size='.3'";
  GasRig rig(world_from_mjcf(fmt::format(
                 "<mujoco><worldbody><geom {0} contype='0' conaffinity='0'/>"
                 "<geom name='f' type='plane' size='1 1 1' pos='0 0 -.5' contype='0' "
                 "conaffinity='0'/><body pos='9 0 0'><freejoint/><geom name='g' {0} contype='0' "
                 "conaffinity='0'/></body></worldbody><contact><pair geom1='f' geom2='g'/>"
                 "</contact></mujoco>",
                 shape)),
             cube_grid(12, .1f));
  rig.solve();
  EXPECT_EQ(count(rig.walls.solid), 144) << "the floor of the pair, and no sphere";
}

TEST(GasObstacles, AreThoseOfTheSnapshotsOwnInstant) {
  auto world = world_from_mjcf(
      "<mujoco><option timestep='.01' gravity='0 0 0'/><worldbody>"
      "<body pos='-.4 0 0'><freejoint/><geom type='sphere' size='.2'/></body>"
      "</worldbody></mujoco>");
  auto sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->post({.what = AddVelocity{Body{1}, {10, 0, 0}}}).ok());
  for (int step = 0; step < 6; ++step) {
    ASSERT_TRUE(sim->step(1).ok());
    const Snapshot s = sim->latest();
    GasRig moved(world, cube_grid(20, .1f));
    ASSERT_TRUE(moved.obstacles->solve(s, &moved.walls).ok());
    const double x = s.data().state[1];  // after the time: qpos
    EXPECT_NEAR(x, -.4 + .1 * (step + 1), 1e-9);
    double middle = 0;
    int cells = 0;
    for_cells(moved.walls.grid, [&](int i, int j, int k, size_t at) {
      const auto p = gas_centre(moved.walls.grid, 3, i, j, k);
      if (!moved.walls.solid[at]) return;
      middle += p[0], ++cells;
    });
    EXPECT_NEAR(middle / cells, x, .02);
  }
}

// Asleep from the start on, and elsewhere since.
TEST(GasObstacles, AreThereWhenTheySleep) {
  GasRig rig(world_from_mjcf("<mujoco><option><flag sleep='enable'/></option><worldbody>"
                             "<geom type='plane' size='2 2 .1' pos='0 0 -.6'/>"
                             "<body pos='0 0 .3' sleep='init'><freejoint/>"
                             "<geom type='box' size='.15 .15 .15'/></body></worldbody></mujoco>"),
             cube_grid(12, .1f));
  ASSERT_EQ(rig.d->ntree_awake, 0);
  rig.d->qpos[2] = -.45;
  rig.solve();
  EXPECT_TRUE(rig.walls.solid[gas_index(rig.walls.grid, 3, 6, 6, 1)]);
  EXPECT_FALSE(rig.walls.solid[gas_index(rig.walls.grid, 3, 6, 6, 8)]);
}

TEST(GasObstacles, AreTheSameForAnyNumberOfThreads) {
  std::vector<GasWalls> all;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    GasRig rig("<geom type='plane' size='1 1 1' pos='0 0 -.2'/>" + tumbler("box' size='.4 .3 .2") +
                   "<body><freejoint/><geom type='sphere' size='.4'/></body>",
               cube_grid(20, .1f));
    spin(rig);
    rig.solve();
    all.push_back(rig.walls);
  }
  set_thread_count(0);
  expect_equal(all[0], all[1]);
  expect_equal(all[0], all[2]);
}

}  // namespace
}  // namespace gloam

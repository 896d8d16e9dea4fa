// Waters: what floats, how deep, how steadily, and how it rocks.

#include "sim/effects/water/water_forces.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "sim/effects/water/water_effect.h"
#include "sim/effects/water/water_surface.h"
#include "sim/state/state_layout.h"
#include "test_world.h"

namespace gloam {
namespace {

constexpr double kRho = 1000, kG = 9.81, kTurn = std::numbers::pi;

WaterOptions calm_water(double edge = 20, double depth = 10) {
  WaterOptions o;
  o.name = "pool";
  o.size = {edge, edge};
  o.depth = depth;
  o.density = kRho;
  o.ripples = false;
  return o;
}

std::shared_ptr<CompiledWorld> world_with_water(const std::string& bodies, const WaterOptions& o,
                                                const std::string& option = {},
                                                const std::string& assets = {}) {
  auto world = world_from_mjcf(fmt::format(
      R"(<mujoco><option timestep="0.002" {}/><asset>{}</asset><worldbody>{}</worldbody></mujoco>)",
      option, assets, bodies));
  Scene scene;
  scene.waters = {o};
  auto waters = describe_waters(scene);
  EXPECT_TRUE(waters.ok()) << waters.error().to_string();
  world->waters = *waters;
  return world;
}

struct Floating {
  std::unique_ptr<Simulator> sim;
  explicit Floating(std::shared_ptr<CompiledWorld> world)
      : sim(make_simulator(std::move(world), lockstep())) {
    sim->start();
  }
  void run(double seconds) { EXPECT_TRUE(sim->step(std::lround(seconds / 0.002)).ok()); }
  JointState joint() { return sim->latest()[Joint{0}]; }
  double z() { return joint().qpos[2]; }
  /// Mean over the seconds to come: drag that grows with v² leaves a small heave for long.
  double mean_z(double seconds) {
    double sum = 0;
    const int count = static_cast<int>(seconds / 0.02);
    for (int i = 0; i < count; ++i) {
      run(0.02);
      sum += z();
    }
    return sum / count;
  }
};

std::string body(const std::string& geom, const std::string& pose = "pos='0 0 0'") {
  return fmt::format("<body {}><freejoint/><geom {}/></body>", pose, geom);
}

// ---- how deep ----

TEST(WaterFloats, BoxesAsDeepAsArchimedesSays) {
  for (const double density : {100.0, 250.0, 500.0, 900.0}) {
    Floating box(world_with_water(
        body(fmt::format("type='box' size='.4 .5 .1' density='{}'", density)), calm_water()));
    box.run(40);
    // Level, with the share density / rho below the surface.
    EXPECT_NEAR(box.mean_z(10), 0.1 - 0.2 * density / kRho, 2e-4) << density << " kg/m³";
  }
}

// Draught of a ball over its radius: V(d) = pi d² (3 r - d) / 3.
double ball_draught(double share) {
  double low = 0, high = 2;
  for (int i = 0; i < 60; ++i) {
    const double d = (low + high) / 2;
    (d * d * (3 - d) / 4 < share ? low : high) = d;
  }
  return low;
}

TEST(WaterFloats, BallsAsDeepAsArchimedesSays) {
  for (const double share : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    Floating ball(world_with_water(
        body(fmt::format("type='sphere' size='.3' density='{}'", share * kRho)), calm_water()));
    ball.run(40);
    EXPECT_NEAR((0.3 - ball.mean_z(10)) / 0.3, ball_draught(share), 0.01)
        << share << " of water's density";
  }
}

TEST(WaterFloats, EveryShapeDisplacesItsVolume) {
  struct Case {
    const char *geom, *asset;
    double volume;
  };
  const Case cases[] = {
      {"type='cylinder' size='.2 .3'", "", kTurn * 0.04 * 0.6},
      {"type='capsule' size='.2 .3'", "", kTurn * 0.04 * (0.6 + 0.8 / 3)},
      {"type='ellipsoid' size='.1 .2 .3'", "", kTurn * 4 / 3 * 0.006},
      {"type='mesh' mesh='wedge'",
       "<mesh name='wedge' vertex='0 0 0  1 0 0  0 1 0  1 1 0  0 0 .5  0 1 .5'/>", 0.25}};
  for (const Case& c : cases) {
    auto world = world_with_water(body(c.geom), calm_water(), "", c.asset);
    for (const int count : {216, 1000}) {
      const ImmersedShape shape = *immersed_shape(*world->model, 0, count);
      double sum = 0;
      for (const VolumeElement& e : shape.elements) sum += e.volume;
      EXPECT_NEAR(sum, c.volume, 0.006 * c.volume) << c.geom << ", " << count << " elements";
    }
  }
}

// The volume under a plane at any height and tilt, against many more elements: it converges.
TEST(WaterFloats, ElementsConverge) {
  auto world =
      world_with_water(body("type='capsule' size='.2 .3' quat='.9 .3 .2 .1'"), calm_water());
  const mjModel& m = *world->model;
  const double n[3] = {0.36, 0.48, 0.8};
  const auto under = [&](const ImmersedShape& s, double level) {
    double cell = 0, volume = 0;
    for (int a = 0; a < 3; ++a) cell += n[a] * s.cell[a];
    for (const VolumeElement& e : s.elements)
      volume += e.volume * std::clamp((level - mju_dot3(n, e.p)) / cell + 0.5, 0.0, 1.0);
    return volume / s.volume;
  };
  const ImmersedShape fine = *immersed_shape(m, 0, 100000);
  double errors[2] = {};
  for (double level = -0.4; level < 0.4; level += 0.01) {
    for (int i = 0; i < 2; ++i)
      errors[i] = std::max(
          errors[i],
          std::abs(under(*immersed_shape(m, 0, i == 0 ? 27 : 216), level) - under(fine, level)));
  }
  EXPECT_LT(errors[1], 0.01) << "of the whole volume, with 216 elements";
  EXPECT_LT(errors[1], errors[0]);
}

// ---- how steadily ----

// A box of density 500 floats upright while its metacentre lies above its centre of mass:
// GM = b² / (12 T) + T / 2 - h / 2 with the draught T = h / 2.
double tilt_after(double width, double height) {
  const double start = 0.05;
  Floating box(world_with_water(
      body(fmt::format("type='box' size='{} 2 {}' density='500'", width / 2, height / 2),
           fmt::format("pos='0 0 0' quat='{} 0 {} 0'", std::cos(start / 2), std::sin(start / 2))),
      calm_water()));
  box.run(40);
  const auto q = box.joint().qpos;
  return 2 * std::atan2(std::hypot(q[4], q[5]), std::abs(q[3]));
}

TEST(WaterFloats, ABoxStandsUprightWhileItsMetacentreIsHigh) {
  // GM = 0 at b / h = sqrt(1.5) = 1.2247.
  EXPECT_LT(tilt_after(0.5 * 1.3, 0.5), 0.04) << "GM > 0: it comes back";
  EXPECT_GT(tilt_after(0.5 * 1.15, 0.5), 0.2) << "GM < 0: it lies over";
}

// Torque at a small heel against rho g V GM sin(heel).
TEST(WaterFloats, TheRightingMomentIsThatOfTheMetacentre) {
  const double b = 1, h = 0.4, length = 2, draught = h / 2;
  const double gm = b * b / (12 * draught) + draught / 2 - h / 2;
  auto world = world_with_water(body("type='box' size='.5 1 .2' density='500'"), calm_water());
  mjModel* m = world->model.get();
  DataPtr d(mj_makeData(m));
  const std::vector<ImmersedShape> shapes = immersed_shapes(*m);
  WaterForces forces(*m, world->waters, shapes);
  const HeightChange still;
  for (const double heel : {0.02, 0.05, 0.1}) {
    const double q[4] = {std::cos(heel / 2), 0, std::sin(heel / 2), 0};
    mju_copy4(d->qpos + 3, q);
    mj_kinematics(m, d.get());
    mj_comPos(m, d.get());
    mj_comVel(m, d.get());
    forces.begin(*m, *d, {&still, 1});
    const double moment = -d->qfrc_applied[4], lift = d->qfrc_applied[2];
    forces.end(*m);
    mju_zero(d->qfrc_applied, m->nv);
    const double weight = 0.5 * kRho * b * h * length * kG;
    EXPECT_NEAR(lift, weight, 0.01 * weight);
    // Wall-sided: GZ = sin(heel) (GM + BM tan²(heel) / 2).
    const double bm = b * b / (12 * draught), t = std::tan(heel);
    const double exact = weight * std::sin(heel) * (gm + bm * t * t / 2);
    EXPECT_NEAR(moment, exact, 0.05 * exact) << "at a heel of " << heel << " rad";
  }
}

// ---- how it moves ----

// Period of the heave from upward crossings of the resting depth.
TEST(WaterFloats, ACylinderHeavesWithItsPeriod) {
  const double r = 0.5, half = 0.2, draught = 0.2;
  auto world = world_with_water(body("type='cylinder' size='.5 .2' density='500'", "pos='0 0 .02'"),
                                calm_water());
  const ImmersedShape shape = *immersed_shape(*world->model, 0);
  Floating disk(std::move(world));
  double before = disk.z(), first = -1, last = -1;
  int periods = -1;
  for (int step = 0; step < 10000; ++step) {
    disk.run(0.002);
    const double now = disk.z();
    if (before < 0 && now >= 0) {
      last = 0.002 * (step + now / (now - before));
      if (first < 0) first = last;
      ++periods;
    }
    before = now;
  }
  ASSERT_GT(periods, 3);
  const double displaced = kRho * kTurn * r * r * draught, stiffness = kRho * kG * kTurn * r * r;
  const double mass = 500 * kTurn * r * r * 2 * half + shape.added[2] * displaced;
  const double exact = 2 * kTurn * std::sqrt(mass / stiffness);
  EXPECT_NEAR((last - first) / periods, exact, 0.01 * exact);
  // The added mass itself, against that of a disk with water on one side, 4/3 rho r³.
  EXPECT_NEAR(shape.added[2] * displaced, 4.0 / 3 * kRho * r * r * r,
              0.6 * 4.0 / 3 * kRho * r * r * r);
}

TEST(WaterFloats, AddedMassIsLambs) {
  auto added = [](const char* geom) {
    auto world = world_with_water(body(geom), calm_water());
    return *immersed_shape(*world->model, 0, 4000);
  };
  for (const double a : added("type='sphere' size='.3'").added) EXPECT_NEAR(a, 0.5, 0.01);
  // A prolate spheroid of 2 to 1: 0.2100 along, 0.7024 across (Lamb 1932, article 115).
  const ImmersedShape egg = added("type='ellipsoid' size='.1 .1 .2'");
  EXPECT_NEAR(egg.added[2], 0.21, 0.01);
  EXPECT_NEAR(egg.added[0], 0.702, 0.01);
  EXPECT_NEAR(egg.added_inertia[2], 0, 1e-6 * egg.volume);
}

// Released deep under water a light ball begins with (rho V - m) g / (m + rho V / 2) and ends at
// the speed at which drag balances its lift.
TEST(WaterFloats, ABallRisesWithItsAddedMassAndEndsAtItsTerminalSpeed) {
  const double r = 0.1, volume = 4.0 / 3 * kTurn * r * r * r, mass = 100 * volume;
  WaterOptions deep = calm_water(20, 100);
  for (const char* attitude : {"1 0 0 0", ".6 .3 -.5 .55"}) {
    const std::string pose = fmt::format("pos='0 0 -90' quat='{}'", attitude);
    Floating ball(world_with_water(body("type='sphere' size='.1' density='100'", pose), deep));
    ball.run(0.002);
    const double start = ball.joint().qvel[2] / 0.002;
    EXPECT_NEAR(start, (kRho * volume - mass) * kG / (mass + kRho * volume / 2), 0.02 * start);
    ball.run(5);
    const double end = std::sqrt(2 * (kRho * volume - mass) * kG / (kRho * 0.47 * kTurn * r * r));
    EXPECT_NEAR(ball.joint().qvel[2], end, 0.03 * end) << attitude;
  }
}

TEST(WaterFloats, BallsSinkByStokesLaw) {
  WaterOptions honey = calm_water(20, 100);
  honey.viscosity = 10;
  const double r = 0.01, mu = 10;
  Floating ball(
      world_with_water(body("type='sphere' size='.01' density='2000'", "pos='0 0 -1'"), honey));
  ball.run(2);
  const double exact = -2.0 / 9 * (2000 - kRho) * kG * r * r / mu;
  EXPECT_NEAR(ball.joint().qvel[2], exact, 0.02 * std::abs(exact));
}

TEST(WaterFloats, ACurrentCarriesWhatFloats) {
  WaterOptions river = calm_water(1000, 5);
  river.current = {0.5, -0.2, 0};
  Floating box(world_with_water(body("type='box' size='.3 .3 .1' density='400'"), river));
  box.run(120);
  EXPECT_NEAR(box.joint().qvel[0], 0.5, 0.02);
  EXPECT_NEAR(box.joint().qvel[1], -0.2, 0.02);
}

TEST(WaterFloats, WhatIsDroppedComesToRest) {
  for (const char* geom :
       {"type='box' size='.2 .3 .02' density='30'", "type='sphere' size='.05' density='20'",
        "type='capsule' size='.05 .3' density='700'"}) {
    Floating thing(
        world_with_water(body(geom, "pos='0 0 2' quat='.9 .3 .2 .24'"), calm_water(100)));
    double most = 0;
    for (int i = 0; i < 60; ++i) {
      thing.run(1);
      most = std::max(most, std::abs(thing.z()));
    }
    EXPECT_LT(most, 2.0) << geom;
    double speed = 0;
    for (const double v : thing.joint().qvel) speed = std::max(speed, std::abs(v));
    EXPECT_LT(speed, 0.25) << geom << " still moves after a minute";
  }
}

TEST(WaterFloats, OutsideOfWaterNothingChanges) {
  const std::string falling = body("type='box' size='.1 .1 .1'", "pos='0 0 50'");
  Floating wet(world_with_water(falling, calm_water()));
  Floating dry(world_from_mjcf(fmt::format(
      R"(<mujoco><option timestep="0.002"/><worldbody>{}</worldbody></mujoco>)", falling)));
  wet.run(1);
  dry.run(1);
  const auto a = wet.joint().qpos, b = dry.joint().qpos;
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin()));
}

TEST(WaterFloats, AUsersForcesStayInTheState) {
  auto world = world_with_water(body("type='box' size='.1 .1 .05' density='500'"), calm_water());
  Floating box(world);
  ASSERT_TRUE(box.sim->post({.what = SetWrench{Body{1}, {0, 0, -10}, {}}}).ok());
  box.run(30);
  EXPECT_NEAR(box.mean_z(10), -10 / (kRho * kG * 0.04), 2e-4) << "pushed down by 10 N";
  const std::span<const double> wrench =
      state_part(*world->model, box.sim->latest().state(), mjSTATE_XFRC_APPLIED);
  EXPECT_EQ(wrench[8], -10);
  for (const double f : state_part(*world->model, box.sim->latest().state(), mjSTATE_QFRC_APPLIED))
    EXPECT_EQ(f, 0) << "water's forces are none of the user's";
}

}  // namespace
}  // namespace gloam

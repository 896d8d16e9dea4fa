// Wind: its mean, gusts and spectrum as asked for, and what it does to bodies.

#include "sim/effects/wind/wind.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "gloam/command.h"
#include "sim/effects/wind/air_drag.h"
#include "test_world.h"

namespace gloam {
namespace {

WindDescription windy(double speed, double intensity, uint64_t seed = 1) {
  WindDescription wind;
  wind.speed = speed;
  wind.gusts = intensity * speed;
  wind.seed = seed;
  return wind;
}

struct WindMoments {
  double mean[3] = {}, deviation[3] = {};
};

WindMoments over_ten_minutes(const Wind& wind) {
  constexpr int kCount = 12000;
  double sum[3] = {}, squares[3] = {};
  for (int i = 0; i < kCount; ++i) {
    const Vec3 v = wind.at(0.05 * i, 10);
    const double parts[3] = {v.x, v.y, v.z};
    for (int a = 0; a < 3; ++a) sum[a] += parts[a], squares[a] += parts[a] * parts[a];
  }
  WindMoments out;
  for (int a = 0; a < 3; ++a) {
    out.mean[a] = sum[a] / kCount;
    out.deviation[a] = std::sqrt(squares[a] / kCount - out.mean[a] * out.mean[a]);
  }
  return out;
}

TEST(Wind, HasTheMeanAndTheDeviationThatAreAskedFor) {
  WindMoments all;
  constexpr int kSeeds = 20;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const WindMoments one = over_ten_minutes(Wind(windy(8, 0.15, seed)));
    EXPECT_NEAR(one.mean[0], 8, 0.2) << "mean of ten minutes, seed " << seed;
    EXPECT_NEAR(one.deviation[0], 1.2, 0.15) << "deviation along the wind, seed " << seed;
    for (int a = 0; a < 3; ++a) {
      all.mean[a] += one.mean[a] / kSeeds;
      all.deviation[a] += one.deviation[a] / kSeeds;
    }
  }
  EXPECT_NEAR(all.mean[0], 8, 0.03);
  EXPECT_NEAR(all.mean[1], 0, 0.03);
  EXPECT_NEAR(all.mean[2], 0, 0.03);
  EXPECT_NEAR(all.deviation[0], 1.2, 0.03 * 1.2) << "along the wind";
  EXPECT_NEAR(all.deviation[1], 0.8 * 1.2, 0.03 * 1.2) << "across";
  EXPECT_NEAR(all.deviation[2], 0.5 * 1.2, 0.03 * 1.2) << "up and down";
}

// Power of the gusts along the wind at a frequency, by a Fourier transform over a Hann window, mean
// of seeds and of neighbouring frequencies.
double power_at(double frequency) {
  constexpr int kCount = 12000, kSeeds = 12, kNear = 12;
  constexpr double kStep = 0.05;
  double power = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Wind wind(windy(8, 0.15, seed));
    std::vector<double> gust(kCount);
    for (int i = 0; i < kCount; ++i)
      gust[static_cast<size_t>(i)] =
          wind.gust(kStep * i).x * (1 - std::cos(2 * std::numbers::pi * i / kCount));
    for (int n = 0; n < kNear; ++n) {
      // A band about the frequency as wide as a few of the tones.
      const double f = frequency * (0.85 + 0.3 * n / (kNear - 1)), w = 2 * std::numbers::pi * f;
      double re = 0, im = 0;
      for (int i = 0; i < kCount; ++i) {
        re += gust[static_cast<size_t>(i)] * std::cos(w * kStep * i);
        im += gust[static_cast<size_t>(i)] * std::sin(w * kStep * i);
      }
      power += (re * re + im * im) * 2 * kStep / (1.5 * kCount) / (kSeeds * kNear);
    }
  }
  return power;
}

TEST(Wind, SpectrumFallsByFiveThirdsInTheInertialRange) {
  // The tones are lines, so what a window of ten minutes sees between two is nothing: the band
  // averages are compared with the slope, not with the level.
  const double low = power_at(0.25), high = power_at(2.5);
  const double slope = std::log(high / low) / std::log(10.0);
  EXPECT_NEAR(slope, -5.0 / 3, 0.25) << "from 0.25 to 2.5 Hz";
}

TEST(Wind, GrowsWithHeightByTheLogarithmicLaw) {
  const Wind wind(windy(10, 0));
  EXPECT_DOUBLE_EQ(wind.mean_speed(10), 10);
  EXPECT_NEAR(wind.mean_speed(1), 10 * std::log(1 / 0.03) / std::log(10 / 0.03), 1e-12);
  EXPECT_EQ(wind.mean_speed(-5), wind.mean_speed(0.1)) << "below the ground as just above it";
  const Vec3 v = wind.at(3, 10);
  EXPECT_DOUBLE_EQ(v.x, 10);
  EXPECT_EQ(v.z, 0);
}

const char* const kLightBall = R"(<mujoco><option timestep="0.002" gravity="0 0 0"/><worldbody>
  <body pos="0 0 10"><freejoint/><geom type="sphere" size=".1" mass=".05"/></body>
  </worldbody></mujoco>)";

std::shared_ptr<CompiledWorld> windy_world(const WindDescription& wind,
                                           const char* xml = kLightBall) {
  auto world = world_from_mjcf(xml);
  world->wind = wind;
  return world;
}

TEST(WindOnBodies, DriftEndsAtTheWindsSpeed) {
  auto sim = make_simulator(windy_world(windy(5, 0)), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(500).ok());
  const double early = sim->latest()[Joint{0}].qvel[0];
  ASSERT_TRUE(sim->step(60000).ok());
  const double late = sim->latest()[Joint{0}].qvel[0];
  EXPECT_GT(early, 0.01);
  EXPECT_LT(early, 4);
  EXPECT_NEAR(late, 5, 0.1);
}

// Models that ask for MuJoCo's fluid get it, equal but for rounding.
TEST(WindOnBodies, LeavesAModelWithAFluidOfItsOwnToMujoco) {
  for (const char* fluid : {" density='1.2' viscosity='1.8e-5'", ""}) {
    const char* shape = fluid[0] == 0 ? " fluidshape='ellipsoid'" : "";
    const std::string xml = fmt::format(
        R"(<mujoco><option timestep="0.002" gravity="0 0 0"{}/><worldbody>
      <body pos="0 0 10"><freejoint/><geom type="box" size=".1 .2 .05" mass=".5"{}/></body>
      </worldbody></mujoco>)",
        fluid, shape);
    auto world = windy_world(windy(7, 0), xml.c_str());
    auto sim = make_simulator(world, lockstep());
    sim->start();
    ASSERT_TRUE(sim->step(100).ok());
    ModelPtr stock(mj_copyModel(nullptr, world->model.get()));
    give_air(&stock->opt);
    DataPtr data(mj_makeData(stock.get()));
    const Wind wind(world->wind);
    for (int i = 0; i < 100; ++i) {
      stock->opt.wind[0] = wind.mean_speed(data->qpos[2]);
      mj_step(stock.get(), data.get());
    }
    const Snapshot s = sim->latest();
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(s[Joint{0}].qvel[size_t(i)], data->qvel[i], 1e-13)
          << "velocity " << i << fluid << shape;
    EXPECT_GT(s[Joint{0}].qvel[0], 0.01);
  }
}

// Drag over rho/2 v² and the area that the wind sees, as published: a sphere 0.47 at any attitude,
// a cube 1.05 on a face and 0.80 on an edge (Hoerner 1965, chapter 3), a cylinder three times as
// long as wide 0.72 across and 0.86 along the wind (ibid.; White, "Fluid Mechanics", table 7.3).
struct PublishedDrag {
  const char* name;
  const char* geom;
  const char* attitude;  // quaternion
  double area;           // that the wind along x sees [m²]
  double coefficient;
};
const PublishedDrag kPublishedDrag[] = {
    {"sphere", "type='sphere' size='.1'", "1 0 0 0", std::numbers::pi * 0.01, 0.47},
    {"turned sphere", "type='sphere' size='.1'", ".9 .3 -.2 .25", std::numbers::pi * 0.01, 0.47},
    {"cube", "type='box' size='.1 .1 .1'", "1 0 0 0", 0.04, 1.05},
    {"cube on its edge", "type='box' size='.1 .1 .1'", "0.92388 0 0 0.38268", 0.04 * M_SQRT2, 0.80},
    {"cylinder across", "type='cylinder' size='.1 .3'", "1 0 0 0", 0.12, 0.72},
    {"cylinder along", "type='cylinder' size='.1 .3'", "0.70711 0 0.70711 0",
     std::numbers::pi * 0.01, 0.86}};

TEST(WindOnBodies, DragIsThePublishedOneOfEachShape) {
  for (const PublishedDrag& row : kPublishedDrag) {
    for (const char* integrator : {"Euler", "implicitfast", "RK4"}) {
      const std::string xml = fmt::format(
          "<mujoco><option timestep='0.002' gravity='0 0 0' integrator='{}'/><worldbody>"
          "<body pos='0 0 10' quat='{}'><freejoint/><geom {} "
          "mass='2'/></body></worldbody></mujoco>",
          integrator, row.attitude, row.geom);
      auto sim = make_simulator(windy_world(windy(7, 0), xml.c_str()), lockstep());
      sim->start();
      ASSERT_TRUE(sim->step(1).ok());
      const double force = sim->latest()[Joint{0}].qvel[0] / 0.002 * 2;
      const double coefficient = force / (0.5 * 1.2 * row.area * 49);
      EXPECT_NEAR(coefficient, row.coefficient, 0.1 * row.coefficient)
          << row.name << ", " << integrator;
      Instant instant;
      ASSERT_TRUE(instant.solve(sim->latest()).ok());
      EXPECT_NEAR(instant.data()->qacc[0] * 2, force, 0.01 * force) << row.name;
    }
  }
}

TEST(WindOnBodies, ABallFallsAtThePublishedTerminalSpeed) {
  const char* const ball = R"(<mujoco><option timestep="0.002"/><worldbody>
    <body pos="0 0 2000"><freejoint/><geom type="sphere" size=".02" mass="2.7e-3"/></body>
    </worldbody></mujoco>)";  // a table-tennis ball
  auto sim = make_simulator(windy_world(windy(1e-6, 0), ball), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(3000).ok());
  const double area = std::numbers::pi * 4e-4;
  const double published = std::sqrt(2 * 2.7e-3 * 9.81 / (1.2 * 0.47 * area));
  EXPECT_NEAR(-sim->latest()[Joint{0}].qvel[2], published, 0.03 * published);
}

TEST(WindOnBodies, WhatIsVeryLightIsCarriedAndDoesNotSwing) {
  auto sim = make_simulator(windy_world(windy(8, 0), R"(<mujoco><option timestep="0.005"
    gravity="0 0 0"/><worldbody><body pos="0 0 10"><freejoint/>
    <geom type="box" size=".1 .1 .001" mass="2e-4"/></body></worldbody></mujoco>)"),
                            lockstep());
  sim->start();
  double before = 0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(sim->step(1).ok());
    const double v = sim->latest()[Joint{0}].qvel[0];
    ASSERT_GE(v, before - 1e-9);
    ASSERT_LE(v, 8 + 1e-9);
    before = v;
  }
  EXPECT_GT(before, 6);
}

TEST(AirDrag, ActsOnEveryJointOfATree) {
  const ModelPtr stock(mj_copyModel(nullptr, world_from_mjcf(R"(<mujoco><worldbody>
    <body pos="0 0 1" quat=".9 .3 -.2 .25"><freejoint/><geom type="box" size=".2 .1 .3" mass="2"/>
      <body pos=".3 0 0" euler="10 20 30"><joint type="hinge" axis="1 2 0"/>
        <geom type="capsule" size=".05 .2" mass=".3"/><geom size=".06" pos="0 0 .3" mass=".1"/>
        <body pos="0 0 .3"><joint type="ball"/>
          <geom size=".1" pos=".1 0 0" mass=".2" contype="0" conaffinity="0"/></body>
        <body pos="0 .2 .1"><geom type="cylinder" size=".1 .02" mass=".4"/></body></body></body>
    <body pos="3 0 0"><joint type="slide" axis="0 1 1"/><geom size=".2" mass=".1"/></body>
    </worldbody></mujoco>)")
                                                 ->model.get()));
  mjModel& m = *stock;
  m.opt.wind[0] = 5, m.opt.wind[1] = -3, m.opt.wind[2] = 0.5;
  DataPtr d(mj_makeData(&m));
  for (int i = 0; i < m.nv; ++i) d->qvel[i] = 4 * random_control(i, 0);
  ASSERT_FALSE(has_own_drag(m));
  AirDrag drag(m);
  mj_forward(&m, d.get());
  drag.push(m, *d);
  // The same by a Jacobian for each part.
  std::vector<double> law(static_cast<size_t>(m.nv));
  const std::vector<DragPart> parts = drag_parts(m);
  EXPECT_EQ(parts.size(), 6u);
  for (const DragPart& part : parts) {
    double p[3], v[3], w[6], force[3] = {}, torque[3] = {};
    part.place(*d, p);
    mj_objectVelocity(&m, d.get(), mjOBJ_BODY, part.body, w, 0);
    mju_sub3(v, p, d->xipos + 3 * part.body);
    mju_cross(v, w, v);
    mju_addTo3(v, w + 3);
    mju_subFrom3(v, m.opt.wind);
    part.add_force(*d, v, kAir, m.opt.timestep, force);
    part.add_torque(*d, w, kAir, m.opt.timestep, torque);
    mj_applyFT(&m, d.get(), force, torque, p, part.body, law.data());
  }
  for (int i = 0; i < m.nv; ++i) {
    EXPECT_NE(d->qfrc_applied[i], 0) << i;
    EXPECT_NEAR(d->qfrc_applied[i], law[size_t(i)], 1e-12 * (1 + std::abs(law[size_t(i)]))) << i;
  }
  m.geom_fluid[0] = 1;
  EXPECT_TRUE(has_own_drag(m)) << "an ellipsoid";
}

TEST(WindOnBodies, AFluidOfTheModelsOwnStays) {
  auto world = windy_world(windy(5, 0.2), R"(<mujoco><option timestep="0.002" density="998"
    viscosity="0.001"/><worldbody><body><freejoint/><geom size=".1"/></body></worldbody></mujoco>)");
  mjOption option = world->model->opt;
  give_air(&option);
  EXPECT_EQ(option.density, 998);
  EXPECT_EQ(option.viscosity, 0.001);
}

uint64_t windy_hash(const WindDescription& wind, SimulatorOptions options) {
  auto sim = make_simulator(windy_world(wind), std::move(options));
  sim->start(1000);
  sim->run_until(1000);
  EXPECT_TRUE(sim->wait().ok());
  return sim->latest().hash();
}

TEST(WindOnBodies, HashIsTheSameAtAnySpeedAndDiffersBySeed) {
  const uint64_t reference = windy_hash(windy(8, 0.2), {});
  EXPECT_EQ(windy_hash(windy(8, 0.2), {.pace = Pace::kRealTime, .speed = 10}), reference);
  EXPECT_NE(windy_hash(windy(8, 0.2, 2), {}), reference);
  EXPECT_NE(windy_hash(windy(8, 0.21), {}), reference);
}

TEST(WindOnBodies, ResetRepeatsTheRunAndACommandTakesItsPlace) {
  auto sim = make_simulator(windy_world(windy(8, 0.2)), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(300).ok());
  const uint64_t first = sim->latest().hash();
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->step(300).ok());
  EXPECT_EQ(sim->latest().hash(), first);
  ASSERT_TRUE(sim->post({.what = SetLiveField{LiveFieldId::kWind, 0, {0, -8, 0}}}).ok());
  const double before = sim->latest()[Joint{0}].qvel[1];
  ASSERT_TRUE(sim->step(2000).ok());
  EXPECT_LT(sim->latest()[Joint{0}].qvel[1], before - 0.5) << "the wind of a Command blows";
}

}  // namespace
}  // namespace gloam

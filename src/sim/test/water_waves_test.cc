// The surface of waters: waves as high and as long as asked for, ripples that keep their energy.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "same_hash.h"
#include "sim/effects/water/water_ripples.h"
#include "sim/effects/water/water_surface.h"

namespace gloam {
namespace {

WaterOptions lake(double height, double period, double depth = 50) {
  WaterOptions o;
  o.name = "lake";
  o.size = {60, 60};
  o.depth = depth;
  o.wave_height = height;
  o.wave_period = period;
  o.ripples = false;
  return o;
}

WaterDescription described(const WaterOptions& o, uint64_t seed = 1) {
  Scene scene;
  scene.sim.seed = seed;
  scene.waters = {o};
  auto waters = describe_waters(scene);
  EXPECT_TRUE(waters.ok()) << waters.error().to_string();
  return waters->front();
}

TEST(WaterWaves, SignificantHeightIsTheOneAskedFor) {
  for (const uint64_t seed : {1, 2, 3}) {
    const WaterDescription water = described(lake(0.4, 3), seed);
    double sum = 0, squares = 0;
    constexpr int kCount = 72000;  // two hours
    for (int i = 0; i < kCount; ++i) {
      const double h = wave_height(water, 3, -7, 0.1 * i);
      sum += h, squares += h * h;
    }
    EXPECT_NEAR(4 * std::sqrt(squares / kCount), 0.4, 0.03 * 0.4) << "seed " << seed;
    EXPECT_NEAR(sum / kCount, 0, 0.002);
  }
}

TEST(WaterWaves, TheHighestThirdHasThatMean) {
  const WaterDescription water = described(lake(0.4, 3));
  std::vector<double> heights;  // of waves, from one upward crossing of rest to the next
  double before = 0, low = 0, high = 0;
  for (int i = 0; i < 144000; ++i) {
    const double h = wave_height(water, 0, 0, 0.05 * i);
    if (before < 0 && h >= 0) {
      heights.push_back(high - low);
      low = high = 0;
    }
    low = std::min(low, h), high = std::max(high, h);
    before = h;
  }
  std::sort(heights.begin(), heights.end(), std::greater<>());
  double mean = 0;
  const size_t third = heights.size() / 3;
  for (size_t i = 0; i < third; ++i) mean += heights[i] / static_cast<double>(third);
  // Of narrow spectra it is four standard deviations; JONSWAP's gives some percent less.
  EXPECT_NEAR(mean, 0.4, 0.1 * 0.4);
}

TEST(WaterWaves, ObeyTheDispersionRelation) {
  for (const double depth : {0.5, 2.0, 50.0}) {
    for (const WaveDescription& wave : described(lake(0.05, 3, depth)).waves) {
      const double exact = 9.81 * wave.k() * std::tanh(wave.k() * depth);
      EXPECT_NEAR(wave.omega * wave.omega, exact, 1e-9 * exact) << "depth " << depth;
    }
  }
}

// Velocity against the surface's own rise, and acceleration against the velocity's change.
TEST(WaterWaves, WaterMovesAsItsSurfaceDoes) {
  const WaterDescription water = described(lake(0.4, 3, 4));
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.37 * i, x = 0.8 * i, y = -0.3 * i;
    const WaveMotion top = wave_motion(water, x, y, 0, t);
    const double rise =
        (wave_height(water, x, y, t + kStep) - wave_height(water, x, y, t - kStep)) / (2 * kStep);
    EXPECT_NEAR(top.velocity.z, rise, 1e-6);
    const WaveMotion a = wave_motion(water, x, y, -1, t - kStep),
                     b = wave_motion(water, x, y, -1, t),
                     c = wave_motion(water, x, y, -1, t + kStep);
    EXPECT_NEAR(b.acceleration.x, (c.velocity.x - a.velocity.x) / (2 * kStep), 1e-6);
    EXPECT_NEAR(b.acceleration.y, (c.velocity.y - a.velocity.y) / (2 * kStep), 1e-6);
    EXPECT_NEAR(b.acceleration.z, (c.velocity.z - a.velocity.z) / (2 * kStep), 1e-6);
    EXPECT_NEAR(wave_motion(water, x, y, -4, t).velocity.z, 0, 1e-12) << "through the bottom";
  }
}

TEST(WaterWaves, TheMeshAndThePatchHaveTheSurfacesHeights) {
  const WaterDescription water = described(lake(0.4, 3));
  const WaterGrid& mesh = water.mesh;
  ASSERT_LE(2 * mesh.nx * mesh.ny, 200000) << "triangles";
  std::vector<float> heights(static_cast<size_t>((mesh.nx + 1) * (mesh.ny + 1)));
  surface_heights(water, {}, 12.5, heights);
  for (const auto& [i, j] : {std::pair{0, 0}, {mesh.nx, 3}, {17, mesh.ny}}) {
    EXPECT_NEAR(double{heights[static_cast<size_t>(j * (mesh.nx + 1) + i)]},
                wave_height(water, water.low_x() + mesh.dx * i, water.low_y() + mesh.dy * j, 12.5),
                1e-5);
  }
  const SurfacePatch patch(water, {}, 2, 3, 0.14, 0.14, 12.5);
  double worst = 0;
  for (const double u : {-1.0, -0.6, 0.0, 0.3, 1.0}) {
    for (const double v : {-1.0, 0.4, 1.0}) {
      worst = std::max(worst, std::abs(patch.height(2 + 0.14 * u, 3 + 0.14 * v) - water.level -
                                       wave_height(water, 2 + 0.14 * u, 3 + 0.14 * v, 12.5)));
    }
  }
  EXPECT_LT(worst, 0.002) << "of waves of 0.4 m over half of the shortest";
}

TEST(WaterWaves, RunWhereTheyAreToldToWithTheirSpread) {
  WaterOptions o = lake(0.4, 3);
  o.wave_to = 90;
  o.spread = 0;
  for (const WaveDescription& wave : described(o).waves) {
    EXPECT_NEAR(wave.kx, 0, 1e-12 + 1e-9 * wave.k());
    EXPECT_GT(wave.ky, 0);
  }
  o.spread = 25;
  double squares = 0;
  int count = 0;
  for (uint64_t seed = 1; seed <= 25; ++seed) {
    for (const WaveDescription& wave : described(o, seed).waves) {
      const double off = std::atan2(-wave.kx, wave.ky) * 180 / std::numbers::pi;
      squares += off * off;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 25, 1.5);
}

// ---- ripples ----

WaterDescription pond() {
  WaterOptions o;
  o.name = "pond";
  o.size = {4, 3};
  return described(o);
}

// A ball that is pushed under and taken away.
void splash(WaterRipples* ripples, const WaterDescription& water, double x, double y) {
  auto world = world_from_mjcf(
      "<mujoco><worldbody><body><freejoint/><geom size='.2'/></body></worldbody></mujoco>");
  const ImmersedShape shape = *immersed_shape(*world->model, 0);
  const double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int i = 0; i < 20; ++i) {
    const double p[3] = {x, y, 0.2 - 0.02 * i};
    ripples->displace(shape, p, R, water.level);
    ripples->advance(1.0 / 60);
  }
  ripples->advance(1.0 / 60);
}

TEST(WaterRipplesGrid, EnergyNeverGrowsAndDiesAway) {
  const WaterDescription water = pond();
  WaterRipples ripples(water, 1.0 / 60);
  EXPECT_EQ(ripples.digest(), 0u);
  splash(&ripples, water, 0.3, 0.2);
  double before = ripples.energy();
  const double first = before;
  ASSERT_GT(first, 1e-6);
  for (int i = 0; i < 60 * 60; ++i) {
    ripples.advance(1.0 / 60);
    const double now = ripples.energy();
    // The scheme keeps an energy that differs from this by terms of the step; none builds up.
    ASSERT_LT(now, 1.02 * first) << "tick " << i;
    if (i % 60 == 59) {
      ASSERT_LE(now, before * 1.001) << "second " << i / 60;
      before = now;
    }
  }
  EXPECT_LT(before, 0.001 * first);
  for (int i = 0; i < 60 * 120 && ripples.digest() != 0; ++i) ripples.advance(1.0 / 60);
  EXPECT_EQ(ripples.digest(), 0u) << "the water is calm again";
  EXPECT_EQ(ripples.field(), nullptr);
}

TEST(WaterRipplesGrid, WavesRunOutAtTheirSpeedAndComeBackFromTheSides) {
  const WaterDescription water = pond();
  WaterRipples ripples(water, 1.0 / 60);
  splash(&ripples, water, 0, 0);
  const auto most_at = [&](double x, double y) {
    return std::abs(ripple_height(water, {ripples.field(), 0}, x, y));
  };
  EXPECT_LT(most_at(1.9, 0), 1e-4) << "before a wave can be there";
  double at_side = 0;
  for (int i = 0; i < 60 * 3; ++i) {
    ripples.advance(1.0 / 60);
    at_side = std::max(at_side, most_at(1.9, 0));
  }
  EXPECT_GT(at_side, 1e-3);
  // Nothing flows through the sides: the mean stays that of what is displaced, here nothing.
  double mean = 0;
  for (const float h : ripples.field()->height) mean += double{h};
  EXPECT_NEAR(mean / static_cast<double>(ripples.field()->height.size()), 0, 1e-6);
}

TEST(WaterRipplesGrid, WhatFloatsStillLeavesTheWaterStill) {
  auto world = world_from_mjcf(R"(<mujoco><option timestep="0.002"/><worldbody>
    <body pos="0 0 -.05"><freejoint/><geom type="box" size=".3 .3 .1" density="748.5"/></body>
    </worldbody></mujoco>)");
  world->waters = {pond()};
  auto sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(30000).ok());
  const Snapshot s = sim->latest();
  ASSERT_NE(s.data().effects.surfaces[0].field, nullptr);
  const auto& heights = s.data().effects.surfaces[0].field->height;
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  EXPECT_LT(*high - *low, 0.001f) << "a minute after it was laid on the water";
}

// ---- in time with physics ----

std::shared_ptr<CompiledWorld> rough_pool(double height = 0.1) {
  std::string bodies;
  for (int i = 0; i < 4; ++i) {
    bodies += "<body pos='" + std::to_string(i * 0.7 - 1) + " " + std::to_string(0.3 * i - 0.4) +
              " 0.6'><freejoint/><geom type='" + (i % 2 == 0 ? "box" : "sphere") +
              "' size='.15 .2 .1' density='400'/></body>";
  }
  auto world = world_from_mjcf(R"(<mujoco><option timestep="0.004"/><worldbody>
    <geom type="plane" size="9 9 .1" pos="0 0 -1"/>)" +
                               bodies + "</worldbody></mujoco>");
  WaterOptions o;
  o.name = "pool";
  o.wave_height = height;
  o.wave_period = 1.5;
  world->waters = {described(o)};
  return world;
}

uint64_t rough_hash(SimulatorOptions options, bool watched = false, double height = 0.1) {
  std::function<void(const Snapshot&)> look;
  if (watched) look = [](const Snapshot&) {};
  return hash_after_steps(make_simulator(rough_pool(height), std::move(options)), 1000, look);
}

TEST(WaterEffectRun, HashDoesNotDependOnThreadsPaceOrWatchers) {
  const uint64_t reference = expect_one_hash(
      [](SimulatorOptions options, bool watched) { return rough_hash(options, watched); });
  EXPECT_NE(rough_hash({}, false, 0.101), reference);
}

TEST(WaterEffectRun, ResetRepeatsTheRun) {
  auto sim = make_simulator(rough_pool(), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(400).ok());
  const uint64_t first = sim->latest().hash();
  ASSERT_NE(sim->latest().data().effects.surfaces[0].field, nullptr);
  ASSERT_TRUE(sim->reset().ok());
  EXPECT_EQ(sim->latest().data().effects.surfaces[0].field, nullptr);
  ASSERT_TRUE(sim->step(400).ok());
  EXPECT_EQ(sim->latest().hash(), first);
}

TEST(WaterEffectRun, ARecompileKeepsTheRipples) {
  auto sim = make_simulator(rough_pool(), lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(401).ok());
  const auto before = sim->latest().data().effects.surfaces[0].field;
  ASSERT_NE(before, nullptr);
  ASSERT_TRUE(sim->recompile(rough_pool(), {}).ok());
  EXPECT_EQ(sim->latest().data().effects.surfaces[0].field, before);
  ASSERT_TRUE(sim->step(100).ok());
}

// Waves and ripples carry what floats for minutes without throwing it.
TEST(WaterEffectRun, RoughWaterStaysPhysical) {
  auto sim = make_simulator(rough_pool(), lockstep());
  sim->start();
  double highest = 0, fastest = 0;
  for (int i = 0; i < 120; ++i) {
    ASSERT_TRUE(sim->step(250).ok());
    const Snapshot s = sim->latest();
    for (int body = 0; body < 4; ++body) {
      const JointState joint = s[Joint{body}];
      const bool inside = std::abs(joint.qpos[0]) < 2 && std::abs(joint.qpos[1]) < 2;
      if (!inside) continue;
      if (i > 3) highest = std::max(highest, joint.qpos[2]);
      if (i > 3)
        fastest = std::max(fastest, std::hypot(joint.qvel[0], joint.qvel[1], joint.qvel[2]));
    }
  }
  EXPECT_LT(highest, 0.4);
  EXPECT_LT(fastest, 1.5);
}

// What docs/water.md says of the cost: microseconds a step, of the pool above with 4, 16 and 64
// bodies.
TEST(WaterEffectCost, DISABLED_Measure) {
  for (const int count : {4, 16, 64}) {
    std::string bodies;
    for (int i = 0; i < count; ++i) {
      bodies += fmt::format(
          "<body pos='{} {} 0.1'><freejoint/><geom type='{}' size='.15 .2 .1' "
          "density='400'/></body>",
          (i % 8) * 1.0 - 3.5, (i / 8) * 1.0 - 3.5, i % 2 == 0 ? "box" : "capsule");
    }
    double micros[3] = {};
    for (int wet = 0; wet < 3; ++wet) {
      auto world = world_from_mjcf(
          fmt::format(R"(<mujoco><option timestep="0.002" {}/><worldbody>{}</worldbody></mujoco>)",
                      wet == 0 ? "gravity='0 0 0'" : "", bodies));
      WaterOptions o;
      o.name = "pool";
      o.size = {8, 8};
      if (wet == 2) o.wave_height = 0.05;
      if (wet == 2) o.wave_period = 1.5;
      o.ripples = wet == 2;
      if (wet > 0) world->waters = {described(o)};
      auto sim = make_simulator(world, lockstep());
      sim->start();
      ASSERT_TRUE(sim->step(500).ok());
      const double before = sim->cpu_time();
      ASSERT_TRUE(sim->step(2000).ok());
      micros[wet] = (sim->cpu_time() - before) / 2000 * 1e6;
    }
    printf("%d bodies: dry %.1f, calm %.1f, waves and ripples %.1f microseconds a step\n", count,
           micros[0], micros[1], micros[2]);
  }
}

}  // namespace
}  // namespace gloam

// Snow that [weather] lays on the ground as a bed of soil: how far bodies sink into it, what it
// does to their tracks as more falls, and that a run is the same however it is run.

#include "same_hash.h"
#include "soil_rig.h"
#include "world/effects/visual_soil.h"

namespace gloam {
namespace {

// No weather is so fast: tests are.
constexpr double kWater = 720;                       // mm/h
constexpr double kRate = 10 * kWater * 1e-3 / 3600;  // of depth [m/s]

std::shared_ptr<CompiledWorld> snowed(const std::string& bodies, double cover, double snow,
                                      double edge = 4) {
  auto world = world_from_mjcf(
      fmt::format(R"(<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
      <geom type="plane" size="9 9 .1"/>{}</worldbody></mujoco>)",
                  bodies));
  Scene scene;
  SoilOptions o = bed_of("snow", edge);
  o.depth.reset(), o.over_ground = true, o.position = {0, 0, 0.5};
  scene.soils = {o};
  scene.weather = WeatherOptions{.snow = snow, .snow_cover = cover};
  auto soils = describe_soils(scene, *world->model);
  EXPECT_TRUE(soils.ok()) << soils.error().to_string();
  world->soils = *soils;
  return world;
}

/// A round plate that slides up and down, so heavy, from `z`; overdamped.
std::string plate(double z, double radius, double pressure) {
  const double mass = pressure * std::numbers::pi * radius * radius / 9.81;
  return fmt::format(
      "<body pos='.013 .007 {}'><joint type='slide' axis='0 0 1' damping='{}'/>"
      "<geom type='cylinder' size='{} .02' mass='{}'/></body>",
      z + 0.02, 40 * mass, radius, mass);
}

TEST(FallenSnow, CarriesAsBekkerSaysAndTheGroundBelowCarriesTheRest) {
  const Law law("snow");
  const double pressure = 2e3, z = law.sinkage(pressure, 0.15);
  ASSERT_LT(z, 0.1);
  OnSoil light(snowed(plate(0.2, 0.15, pressure), 0.2, 0));
  light.run(4);
  EXPECT_NEAR(-light.q(0), z, 0.05 * z);
  EXPECT_NEAR(light.track(0, 0), -z, 0.1 * z);
  OnSoil heavy(snowed(plate(0.2, 0.15, 60e3), 0.2, 0));
  heavy.run(4);
  EXPECT_NEAR(-heavy.q(0), 0.2, 0.003) << "on the ground";
  OnSoil bare(snowed(plate(0, 0.15, pressure), 0, 0));
  bare.run(1);
  EXPECT_NEAR(bare.q(0), 0, 0.003) << "no snow";
}

TEST(FallenSnow, GrowsAsTheWeatherSaysAndLiftsNothing) {
  const double pressure = 300, z = Law("snow").sinkage(pressure, 0.15), cover = 0.1;
  const double speed = 9.81 / 40, seconds = 10;
  OnSoil later(snowed(plate(cover + speed * seconds, 0.15, pressure), cover, kWater));
  const double start = cover + speed * seconds;
  later.run(seconds + 1);
  const double landed = start + later.q(0);
  EXPECT_NEAR(landed, cover + kRate * seconds - z, 0.003);
  later.run(20);
  EXPECT_NEAR(start + later.q(0), landed, 0.001) << "on what has fallen around it";
  EXPECT_NEAR(later.track(0, 0), landed - cover - kRate * (seconds + 21), 0.002);
}

// A plate is pressed in and taken away; a lighter one comes back later.
TEST(FallenSnow, FillsInTracksByAsMuchAsFallsSeenAndFelt) {
  const double radius = 0.15, pressure = 2e3, cover = 0.2, gap = 5;
  auto world = snowed(plate(cover, radius, pressure), cover, kWater);
  OnSoil rig(world);
  const auto move = [&](double q) {
    ASSERT_TRUE(rig.sim->post({.what = SetJointState{Joint{0}, {q}, {0}}}).ok());
  };
  rig.run(4);
  const double deep = rig.q(0);
  EXPECT_NEAR(rig.track(0, 0), deep - kRate * 4, 0.002);
  const float mass = static_cast<float>(world->model->body_mass[1] / 4);
  ASSERT_TRUE(rig.sim->post({.what = SetLiveField{LiveFieldId::kBodyMass, 1, {mass}}}).ok());
  move(3);
  rig.run(gap);
  EXPECT_NEAR(rig.track(0, 0), deep - kRate * 4 + kRate * gap, 0.002);
  EXPECT_NEAR(rig.track(0.8, 0), 0, 1e-6);
  move(deep + 2 * kRate * gap + 0.01);
  rig.run(0.5);
  EXPECT_NEAR(rig.q(0), deep + 2 * kRate * gap, 0.003) << "on the bottom of what is left of it";
  move(3);
  rig.run(40);
  EXPECT_EQ(rig.track(0, 0), 0) << "no track is left";
  const double z = Law("snow").sinkage(pressure / 4, radius),
               now = kRate * rig.sim->latest().time();
  move(now - z + 0.02);
  rig.run(2);
  EXPECT_NEAR(rig.q(0), now - z, 0.004) << "as in fresh snow";
}

std::shared_ptr<CompiledWorld> busy_snow(double water = kWater) {
  std::string bodies;
  for (int i = 0; i < 4; ++i) {
    bodies += fmt::format(
        "<body pos='{} {} .3' quat='.9 .1 {} .3'><freejoint/><geom type='{}' size='.08 .06 .05' "
        "density='2500'/></body>",
        i * 0.4 - 0.6, 0.2 * i - 0.3, 0.2 * i, i % 2 == 0 ? "box" : "sphere");
  }
  return snowed(bodies, 0.1, water, 2);
}

TEST(FallenSnow, HashDoesNotDependOnThreadsPaceOrWatchers) {
  const uint64_t reference = expect_one_hash([](SimulatorOptions options, bool watched) {
    std::function<void(const Snapshot&)> look;
    if (watched) look = [](const Snapshot&) {};
    return hash_after_steps(make_simulator(busy_snow(), std::move(options)), 600, look);
  });
  EXPECT_NE(hash_after_steps(make_simulator(busy_snow(0), {}), 600, {}), reference);
}

TEST(FallenSnow, ResetRepeatsTheRunAndARecompileKeepsTheTracks) {
  OnSoil rig(busy_snow());
  rig.steps(400);
  const uint64_t first = rig.sim->latest().hash();
  const std::vector<float> tracks = rig.sim->latest().data().effects.surfaces[0].field->height;
  ASSERT_TRUE(rig.sim->reset().ok());
  rig.steps(400);
  EXPECT_EQ(rig.sim->latest().hash(), first);
  EXPECT_EQ(rig.sim->latest().data().effects.surfaces[0].field->height, tracks);
  ASSERT_TRUE(rig.sim->recompile(busy_snow(), {}).ok());
  EXPECT_EQ(rig.sim->latest().data().effects.surfaces[0].field->height, tracks);
  ASSERT_TRUE(rig.sim->recompile(busy_snow(0), {}).ok());
  EXPECT_EQ(rig.sim->latest().data().effects.surfaces[0].field, nullptr) << "other snow";
}

}  // namespace
}  // namespace gloam

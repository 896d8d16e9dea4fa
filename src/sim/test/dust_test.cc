// Dust that ground gives: the laws, and what rolls, falls, walks and blows over it.

#include <chrono>
#include <numeric>

#include "agent_rig.h"
#include "same_hash.h"
#include "sim/effects/dust/contact_dust.h"
#include "sim/effects/dust/dust_law.h"
#include "sim/snapshots/pose_solver.h"
#include "soil_rig.h"

namespace gloam {
namespace {

TEST(DustLaw, IsWhatWasPublished) {
  // AP-42's own normalisation: 4.9 lb per mile at 12 % silt and 3 short tons.
  EXPECT_NEAR(rolling_dust(0.12, 3 * 907.185), 4.9 * 0.45359 / 1609.34, 2e-6) << "kg/m";
  EXPECT_NEAR(rolling_dust(0.24, 6 * 907.185) / rolling_dust(0.12, 3 * 907.185),
              std::pow(2, 0.7 + 0.45), 1e-9);
  EXPECT_EQ(saltation_dust(0.3, 0.3, 0.1, 1.2), 0) << "below the threshold";
  // White's flux of grains at twice the threshold is 2.61 rho/g u³ 9/8; a clay of 10 % gives
  // 10^(1.34 - 6) of it per cm.
  EXPECT_NEAR(saltation_dust(0.6, 0.3, 0.1, 1.2),
              2.61 * 1.2 / 9.81 * 0.216 * 9 / 8 * std::pow(10, -4.66) * 100, 1e-9);
  // Far above the threshold it grows with the cube.
  EXPECT_NEAR(saltation_dust(20, 0.2, 0.1, 1.2) / saltation_dust(10, 0.2, 0.1, 1.2), 8, 0.2);
  EXPECT_NEAR(friction_velocity(6.2146, 0.25), 0.4, 1e-3) << "m/s: u = u*/0.4 ln(500)";
}

struct Yard {
  std::string bodies;
  std::string rest;  // of the MJCF
  Vec3f low{-2, -2, 0};
  int nx = 40, ny = 40, nz = 15;
  bool closed = true;
};

/// Dusty ground everywhere under a box of air.
std::shared_ptr<CompiledWorld> dusty(const Yard& yard) {
  auto world = world_from_mjcf(
      "<mujoco><option timestep=\"0.002\"/><worldbody>"
      "<geom type=\"plane\" size=\"9 9 .1\"/>" +
      yard.bodies + "</worldbody>" + yard.rest + "</mujoco>");
  GasDescription gas;
  gas.name = "air";
  gas.low = yard.low;
  gas.nx = yard.nx, gas.ny = yard.ny, gas.nz = yard.nz;
  gas.voxel = 0.1f;
  gas.rate = {20, 1};
  gas.medium.name = "dust";
  gas.fuel = {25e6f, 0.1f, 0.3f};
  gas.temperature = 293;
  std::fill(std::begin(gas.open), std::end(gas.open), !yard.closed);
  world->gases.gases.push_back(gas);
  DustDescription dust;
  dust.low = {-100, -100, -100}, dust.high = {100, 100, 100};
  dust.silt = 0.1f, dust.clay = 0.1f, dust.threshold = 0.25f;
  world->gases.dusts.push_back(dust);
  return world;
}

double dust_in(const Snapshot& snapshot) {  // [kg]
  auto solver = *PoseSolver::create(snapshot.data().world);
  PoseFrame frame;
  EXPECT_TRUE(solver->solve(snapshot, frame).ok());
  const std::vector<float>& density = *frame.fields[0].density;
  return 1e-3 * std::accumulate(density.begin(), density.end(), 0.0);
}

double dust_after(const std::shared_ptr<CompiledWorld>& world, int64_t steps) {
  auto sim = make_simulator(world, lockstep());
  sim->start();
  EXPECT_TRUE(sim->step(steps).ok());
  return dust_in(sim->latest());
}

TEST(Dust, ARollingWheelRaisesWhatItsWayAsksFor) {
  // A ball of 20 kg at 1 m/s without slip, for 1.5 s.
  Yard yard;
  yard.bodies =
      "<body name=\"ball\" pos=\"-1 0 .2\"><freejoint/><geom size=\".2\" mass=\"20\"/></body>";
  yard.rest = "<keyframe><key qpos=\"-1 0 .2 1 0 0 0\" qvel=\"1 0 0 0 5 0\"/></keyframe>";
  auto world = dusty(yard);
  world->initial_key = 0;
  const double dust = dust_after(world, 775);
  const double law = rolling_dust(0.1, 20) * 1.5;
  printf("a ball of 20 kg raised %.3g kg over 1.5 m, law %.3g\n", dust, law);
  EXPECT_NEAR(dust, law, 0.15 * law) << "kg";
}

// A box of 2 kg and 0.2 m with its middle at a height [m].
Yard yard_with_box(double height) {
  Yard yard;
  yard.bodies = "<body pos=\"0 0 " + std::to_string(height) +
                "\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\" mass=\"2\"/></body>";
  return yard;
}

TEST(Dust, WhatFallsRaisesDustByItsEnergy) {
  const double dust = dust_after(dusty(yard_with_box(0.5)), 600);
  const double law = dust_per_energy(0.1) * 2 * 9.81 * 0.4;
  printf("a fall of 0.4 m with 2 kg raised %.3g kg, law %.3g\n", dust, law);
  EXPECT_NEAR(dust, law, 0.5 * law) << "kg";
}

constexpr double kSand = 0.17;  // [m]: feet are in voxels that are solid

/// The same ground under sand.
std::shared_ptr<CompiledWorld> sandy(const Yard& yard) {
  auto world = dusty(yard);
  Scene scene;
  SoilOptions bed = bed_of("dry_sand", 3, kSand);
  bed.position = {0, 0, kSand};
  scene.soils = {bed};
  world->soils = *describe_soils(scene, *world->model);
  return world;
}

TEST(Dust, WhatFallsOnSandRaisesDustByItsEnergy) {
  const double dust = dust_after(sandy(yard_with_box(kSand + 0.5)), 600);
  // And a little more: it sinks in, and speeds are those at the beginning of steps.
  const double law = dust_per_energy(0.1) * 2 * 9.81 * 0.4;
  printf("a fall of 0.4 m with 2 kg onto sand raised %.3g kg, law %.3g\n", dust, law);
  EXPECT_GT(dust, law) << "kg";
  EXPECT_LT(dust, 1.3 * law) << "kg";
}

TEST(Dust, WhatRollsThroughSandRaisesItsWaysOrItsEnergys) {
  Yard yard;
  yard.bodies = "<body><freejoint/><geom size=\".2\" mass=\"20\"/></body>";
  yard.rest = "<keyframe><key qpos=\"-1 0 .37 1 0 0 0\" qvel=\"1 0 0 0 5 0\"/></keyframe>";
  auto world = sandy(yard);
  world->initial_key = 0;
  auto sim = make_simulator(world, lockstep());
  sim->start();
  ASSERT_TRUE(sim->step(2500).ok());
  const Snapshot now = sim->latest();
  const auto q = now[Joint{0}].qpos;
  const double way = q[0] + 1, sunk = kSand + 0.2 - q[2];
  ASSERT_GT(way, 0.1) << "m: it rolls";
  const double energy = 20 * (0.5 * (1 + 0.4 * 0.04 * 25) + 9.81 * sunk);  // all of it
  const double dust = dust_in(now), law = rolling_dust(0.1, 20) * way;
  printf(
      "a ball of 20 kg rolled %.2f m through sand and raised %.3g kg; by its way %.3g, by its "
      "energy %.3g\n",
      way, dust, law, dust_per_energy(0.1) * energy);
  EXPECT_GT(dust, 0.9 * std::max(law, 0.9 * dust_per_energy(0.1) * energy)) << "kg";
  EXPECT_LT(dust, 1.1 * (law + dust_per_energy(0.1) * energy)) << "kg";
}

TEST(Dust, WhatStandsInSandRaisesNone) {
  const auto world = sandy(yard_with_box(kSand + 0.1));
  const double sunk = dust_after(world, 500);
  EXPECT_GT(sunk, 0) << "kg: it has sunk in";
  EXPECT_NEAR(dust_after(world, 1500), sunk, 0.02 * sunk) << "kg: it goes on";
}

TEST(Dust, WhatStandsRaisesNone) {
  EXPECT_LT(dust_after(dusty(yard_with_box(0.1)), 600),
            0.005 * dust_per_energy(0.1) * 2 * 9.81 * 0.4)
      << "kg";
}

TEST(Dust, OnlyGroundThatIsDustyGivesAny) {
  Yard yard;
  yard.bodies =
      "<body pos=\"0 0 .5\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\" mass=\"2\"/></body>";
  auto world = dusty(yard);
  world->gases.dusts[0].low.x = 1;
  EXPECT_EQ(dust_after(world, 400), 0) << "kg";
}

/// Four rotors over the ground that carry 1.2 kg, held by their weld to the world's frame: a post.
Yard hovering(double height, double thrust, float radius = 0.15f) {
  Yard yard;
  yard.closed = false;
  yard.low = {-1.2f, -1.2f, 0};
  yard.nx = yard.ny = 24, yard.nz = 14;
  yard.bodies = "<body name=\"drone\" pos=\"0 0 " + std::to_string(height) +
                "\"><joint type=\"slide\" axis=\"0 0 1\" stiffness=\"1e5\" damping=\"1e3\"/>"
                "<geom type=\"box\" size=\".08 .08 .03\" mass=\"1.2\"/>"
                "<site name=\"hub\"/><geom name=\"disc\" type=\"cylinder\" size=\"" +
                std::to_string(radius) + " .01\" mass=\".01\"/></body>";
  yard.rest =
      "<actuator><motor name=\"thrust\" site=\"hub\" gear=\"0 0 1 0 0 0\"/></actuator>"
      "<keyframe><key qpos=\"0\" ctrl=\"" +
      std::to_string(thrust) + "\"/></keyframe>";
  return yard;
}

std::shared_ptr<CompiledWorld> rotor_world(const Yard& yard) {
  auto world = dusty(yard);
  world->initial_key = 0;
  RotorDescription rotor;
  rotor.body = 1, rotor.actuator = 0, rotor.radius = 0.3f, rotor.thrust = 1;
  rotor.axis_B = {0, 0, 1};
  rotor.blades = {2};
  world->gases.rotors.push_back(rotor);
  return world;
}

TEST(Dust, ARotorNearTheGroundBlowsItUp) {
  const double strong = dust_after(rotor_world(hovering(0.8, 12)), 500);
  const double stronger = dust_after(rotor_world(hovering(0.8, 24)), 500);
  const double weak = dust_after(rotor_world(hovering(0.8, 0.2)), 500);
  printf("dust in the air after 1 s: %.3g kg (12 N at 0.8 m), %.3g (24 N), %.3g (0.2 N)\n", strong,
         stronger, weak);
  EXPECT_GT(strong, 1e-6) << "kg";
  EXPECT_GT(stronger, 1.5 * strong) << "kg: twice the thrust";
  EXPECT_EQ(weak, 0) << "kg: air that moves slower than the threshold raises none";
}

TEST(Dust, BladesLetAirThrough) {
  auto with = rotor_world(hovering(0.8, 12, 0.3f)), without = with;
  const double through = dust_after(with, 500);
  auto walled = rotor_world(hovering(0.8, 12, 0.3f));
  walled->gases.rotors[0].blades.clear();
  EXPECT_GT(through, 2 * dust_after(walled, 500)) << "kg: a solid disc lets no air through";
}

TEST(Dust, CostOfContactsPerStep) {
  Yard yard;
  for (int i = 0; i < 5; ++i) {
    yard.bodies += "<body pos=\"0 " + std::to_string(0.3 * i) +
                   " .0999\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\"/></body>";
  }
  const auto world = dusty(yard);
  const DataPtr data(mj_makeData(world->model.get()));
  mj_forward(world->model.get(), data.get());
  ASSERT_EQ(data->ncon, 20);
  ContactDust dust(*world, {-9, -9, -1}, {9, 9, 9});
  double best = 1e9;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int n = 0; n < 2000; ++n) dust.gather(*world->model, *data, {});
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / 2000);
  }
  printf("dust of 20 contacts: %.2f us a step\n", best);
  EXPECT_LT(best, 60) << "us a step";
}

TEST(Dust, HashDoesNotDependOnThreadsPaceOrWatchers) {
  expect_one_hash([](SimulatorOptions options, bool watched) {
    Yard yard = hovering(0.6, 12);
    yard.bodies += "<body pos=\".7 0 .3\"><freejoint/><geom size=\".05\" mass=\".002\"/></body>";
    yard.rest.clear();
    auto world = dusty(yard);
    RotorDescription rotor;
    rotor.body = 1, rotor.radius = 0.3f, rotor.thrust = 12, rotor.axis_B = {0, 0, 1};
    world->gases.rotors.push_back(rotor);
    std::function<void(const Snapshot&)> look;
    if (watched) look = [](const Snapshot& snapshot) { dust_in(snapshot); };
    return hash_after_steps(make_simulator(world, std::move(options)), 250, look);
  });
}

TEST(Dust, PeopleRaiseItWithEachStep) {
  AgentRig rig(agent_place(""));
  AgentOptions& walker = rig.add("walker", {-2, 0, 0}, "route");
  walker.route = {{.position = {3, 0, 0}}};
  walker.loop = false;
  GasOptions& gas = rig.scene.gases.emplace_back();
  gas.name = "air";
  gas.position = Vec3{0, 0, 0.75};
  gas.size = Vec3{6, 2, 1.5};
  gas.medium = "dust";
  gas.closed = {"-x", "+x", "-y", "+y", "+z"};
  rig.scene.dusts.emplace_back().name = "floor";
  auto stepper = rig.stepper();
  for (int n = 0; n < 1550; ++n) ASSERT_TRUE(stepper->step());
  const double walked = motion_of(*stepper, 0).p.x + 2;
  const double step =
      dust_per_energy(0.085) * step_energy(stepper->world().agents[0].person.mass, 1.3);
  auto solver = *PoseSolver::create(stepper->shared_world());
  const double dust = dust_in(stepper->snapshot());
  printf("someone walked %.2f m and raised %.3g kg: %.1f steps' worth\n", walked, dust,
         dust / step);
  EXPECT_GT(walked, 1.5) << "m";
  EXPECT_GT(dust, 0.6 * step * walked / 0.8) << "kg";
  EXPECT_LT(dust, 1.4 * step * walked / 0.6) << "kg";
}

}  // namespace
}  // namespace gloam

// Air that pushes bodies: what moving air does that MuJoCo's own still air does not.

#include "sim/effects/gas/gas_forces.h"

#include <array>
#include <chrono>
#include <cmath>

#include "sim/effects/wind/wind.h"
#include "test_world.h"

namespace gloam {
namespace {

std::string ball_model(double mass, double radius, const char* gravity = "0 0 -9.81",
                       const char* more = "") {
  return "<mujoco><option timestep=\"0.002\" gravity=\"" + std::string(gravity) +
         "\"/><worldbody><body pos=\"0 0 2\"><freejoint/><geom size=\"" + std::to_string(radius) +
         "\" mass=\"" + std::to_string(mass) + "\"/></body>" + more + "</worldbody></mujoco>";
}

/// 4 x 4 x 20 m around the z axis from z = -10, in voxels of 0.5 m.
GasDescription tall_gas() {
  GasDescription gas;
  gas.name = "air";
  gas.low = {-2, -2, -10};
  gas.nx = gas.ny = 8, gas.nz = 40;
  gas.voxel = 0.5f;
  gas.rate = {20, 1};
  gas.fuel = {25e6f, 0.1f, 0.3f};
  gas.temperature = 293;
  std::fill(std::begin(gas.open), std::end(gas.open), true);
  return gas;
}

/// A model in air that moves at `wind` and is of `kelvin` everywhere; `fluid`: with a fluid of its
/// own, and so MuJoCo's law of drag.
struct Stream {
  explicit Stream(const std::string& xml, Vec3f wind, float kelvin = 293, bool fluid = true)
      : Stream(world_in_gas(xml, fluid), wind, kelvin) {}
  Stream(std::shared_ptr<CompiledWorld> in, Vec3f wind, float kelvin = 293) : world(std::move(in)) {
    model = *world->model;
    data.reset(mj_makeData(&model));
    forces = std::make_unique<GasForces>(*world, Rational{1, 500});
    const size_t cells = 8 * 8 * 40;
    std::vector<float> velocity;
    for (size_t c = 0; c < cells; ++c) velocity.insert(velocity.end(), {wind.x, wind.y, wind.z});
    const auto grid = [](std::vector<float> values) {
      return std::make_shared<const std::vector<float>>(std::move(values));
    };
    field.finish(grid(std::vector<float>(cells)), grid(std::vector<float>(cells, kelvin)), {},
                 grid(velocity), 0);
    mj_forward(&model, data.get());
  }
  static std::shared_ptr<CompiledWorld> world_in_gas(const std::string& xml, bool fluid) {
    auto made = world_from_mjcf(xml);
    made->gases.gases.push_back(tall_gas());
    if (fluid) give_air(&made->model->opt);
    return made;
  }
  void run(int steps) {
    for (int n = 0; n < steps; ++n, ++step) {
      forces->begin_step(step, model, *data, [&](size_t) -> const MediumField& { return field; });
      mj_step(&model, data.get());
      mju_zero(data->qfrc_applied, model.nv);
    }
  }

  std::shared_ptr<CompiledWorld> world;
  mjModel model;
  DataPtr data;
  std::unique_ptr<GasForces> forces;
  MediumField field;
  int64_t step = 0;
};

/// Speed at which MuJoCo's drag on a ball's box of inertia carries its weight [m/s].
double terminal_speed(double mass, double radius, double density) {
  const double edge = std::sqrt(2.4) * radius;
  const double a = density / 2 * edge * edge, b = 3 * M_PI * edge * kAirViscosity;
  return (-b + std::sqrt(b * b + 4 * a * mass * 9.81)) / (2 * a);
}

TEST(GasForces, ALightBallFallsAtItsTerminalSpeedThroughARisingStream) {
  for (const float wind : {0.0f, 3.0f, 5.0f, 8.0f}) {
    Stream stream(ball_model(1.5e-3, 0.02), {0, 0, wind});
    stream.run(1000);  // 2 s: four of its time constants
    const double v = stream.data->qvel[2],
                 law = double(wind) - terminal_speed(1.5e-3, 0.02, kAirDensity);
    printf("ball of 1.5 g in a stream of %.0f m/s: %.3f m/s (%.3f by the balance of forces)\n",
           double(wind), v, law);
    EXPECT_NEAR(v, law, 0.05) << "m/s in a stream of " << wind << " m/s";
  }
}

// Hoerner's 0.47 of a sphere.
TEST(GasForces, AModelWithoutAFluidFeelsThePublishedDrag) {
  const double fall =
      std::sqrt(2 * 1.5e-3 * 9.81 / (kAirDensity * 0.47 * M_PI * 0.04 * 0.04));  // [m/s]
  for (const float wind : {0.0f, 3.0f, 5.0f}) {  // with more it leaves the stream
    Stream stream(ball_model(1.5e-3, 0.04), {0, 0, wind}, 293, false);
    stream.run(1000);
    EXPECT_NEAR(stream.data->qvel[2], double(wind) - fall, 0.03 * fall)
        << "m/s in a stream of " << wind << " m/s";
  }
}

// Inside the drag of the gas, outside that of the wind, by one law.
TEST(GasForces, WhereTheGasMovesAsTheWindDoesTheGasChangesNothing) {
  auto world = Stream::world_in_gas(ball_model(0.01, 0.05, "0 0 0"), false);
  world->wind.speed = 5;
  Stream in_wind(world, {4, 0, 0});
  in_wind.model.opt.wind[0] = 4;
  in_wind.forces->begin_step(0, in_wind.model, *in_wind.data,
                             [&](size_t) -> const MediumField& { return in_wind.field; });
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(in_wind.data->qfrc_applied[i], 0, 1e-12) << i;
  in_wind.model.opt.wind[0] = 0;
  in_wind.forces->reset();
  in_wind.forces->begin_step(0, in_wind.model, *in_wind.data,
                             [&](size_t) -> const MediumField& { return in_wind.field; });
  EXPECT_GT(in_wind.data->qfrc_applied[0], 0.01);
}

TEST(GasForces, WhatAirCannotMoveIsLeftAlone) {
  Stream heavy(ball_model(20, 0.1, "0 0 0"), {0, 1, 0}, 293, false);
  heavy.run(50);
  EXPECT_EQ(heavy.data->qvel[1], 0) << "m/s: 20 kg in a breeze of 1 m/s";
  Stream light(ball_model(0.2, 0.1, "0 0 0"), {0, 1, 0}, 293, false);
  light.run(50);
  EXPECT_GT(light.data->qvel[1], 1e-3) << "m/s";
}

TEST(GasForces, HotAirIsThinner) {
  Stream stream(ball_model(1.5e-3, 0.02), {0, 0, 5}, 586);
  stream.run(800);
  EXPECT_NEAR(stream.data->qvel[2], 5 - terminal_speed(1.5e-3, 0.02, kAirDensity / 2), 0.1)
      << "m/s";
}

TEST(GasForces, StillAirChangesNothingAtAll) {
  Stream still(ball_model(1.5e-3, 0.02), {});
  mjModel plain = still.model;
  DataPtr alone(mj_makeData(&plain));
  mj_forward(&plain, alone.get());
  still.run(400);
  for (int n = 0; n < 400; ++n) mj_step(&plain, alone.get());
  EXPECT_EQ(still.data->qpos[2], alone->qpos[2]) << "m";
  EXPECT_EQ(still.data->qvel[2], alone->qvel[2]) << "m/s";
}

TEST(GasForces, DragTakesABodyAlongAndNoFaster) {
  for (const double mass : {0.1, 1e-3, 1e-4}) {
    Stream stream(ball_model(mass, 0.05, "0 0 0"), {4, 0, 0});
    double before = 0;
    for (int n = 0; n < 200; ++n) {
      stream.run(1);
      const double v = stream.data->qvel[0];
      EXPECT_LE(v, 4 + 1e-9) << "m/s: faster than the air, " << mass << " kg, step " << n;
      EXPECT_GE(v, before - 1e-9) << "m/s: it slows down, " << mass << " kg, step " << n;
      before = v;
    }
    EXPECT_GT(before, mass < 0.01 ? 3.0 : 0.01) << "m/s of " << mass << " kg";
    EXPECT_NEAR(stream.data->qvel[1], 0, 1e-12);
  }
}

TEST(GasForces, ForcesOfOthersStayAsTheyAre) {
  Stream stream(ball_model(0.1, 0.05), {4, 0, 1});
  stream.data->xfrc_applied[6] = 0.25;
  stream.run(3);
  EXPECT_EQ(stream.data->xfrc_applied[6], 0.25) << "N";
}

TEST(GasForces, OutsideOfItsBoxAGasDoesNothing) {
  Stream stream(ball_model(1.5e-3, 0.02, "0 0 0"), {5, 0, 0});
  stream.data->qpos[0] = 3;  // m; the box ends at 2
  mj_forward(&stream.model, stream.data.get());
  stream.run(20);
  EXPECT_EQ(stream.data->qvel[0], 0) << "m/s";
}

/// Hovers on four constant thrusts, which is all that holds it.
std::shared_ptr<CompiledWorld> drone_world(bool in_gas, float wind) {
  auto world =
      world_from_mjcf(R"(<mujoco><option timestep="0.002" density="1.2" viscosity="1.8e-5"/>
    <worldbody><body name="drone" pos="0 0 1.5"><freejoint/>
      <geom type="box" size=".12 .12 .04" mass="1.2"/>
      <site name="a" pos=".2 .2 .05"/><site name="b" pos="-.2 .2 .05"/>
      <site name="c" pos=".2 -.2 .05"/><site name="d" pos="-.2 -.2 .05"/></body></worldbody>
    <actuator><motor site="a" gear="0 0 1 0 0 0"/><motor site="b" gear="0 0 1 0 0 0"/>
      <motor site="c" gear="0 0 1 0 0 0"/><motor site="d" gear="0 0 1 0 0 0"/></actuator>
    <keyframe><key qpos="0 0 1.5 1 0 0 0" ctrl="2.943 2.943 2.943 2.943"/></keyframe></mujoco>)");
  world->initial_key = 0;
  if (!in_gas) return world;
  GasDescription gas = tall_gas();
  gas.low = {-1.5f, -1.5f, 0};
  gas.nx = gas.ny = 30, gas.nz = 24;
  gas.voxel = 0.1f;
  gas.wind = Vec3f{wind, 0, 0};
  world->gases.gases.push_back(gas);
  for (int i = 0; i < 4; ++i) {
    RotorDescription rotor;
    rotor.body = 1, rotor.actuator = i, rotor.radius = 0.12f, rotor.thrust = 1;
    rotor.p_B = {i % 2 == 0 ? 0.2f : -0.2f, i < 2 ? 0.2f : -0.2f, 0.05f};
    rotor.axis_B = {0, 0, 1};
    world->gases.rotors.push_back(rotor);
  }
  return world;
}

TEST(GasForcesOnDrones, ADroneIsNotBlownDownByItsOwnRotorsButAsideByWind) {
  const auto after = [](std::shared_ptr<CompiledWorld> world) {
    auto sim = make_simulator(std::move(world), lockstep());
    sim->start();
    EXPECT_TRUE(sim->step(1000).ok());
    const std::vector<double>& state = sim->latest().data().state;  // time, then qpos
    return std::array<double, 3>{state[1], state[2], state[3]};
  };
  const auto alone = after(drone_world(false, 0)), still = after(drone_world(true, 0)),
             windy = after(drone_world(true, 6));
  printf(
      "after 2 s of hovering: %.4f m high without gas, (%.4f, %.4f, %.4f) in it, (%.3f, %.3f, "
      "%.3f) "
      "in a wind of 6 m/s\n",
      alone[2], still[0], still[1], still[2], windy[0], windy[1], windy[2]);
  EXPECT_NEAR(still[2], alone[2], 0.03) << "m high";
  EXPECT_NEAR(still[0], 0, 0.01) << "m aside";
  EXPECT_GT(windy[0], 0.02) << "m along the wind";
}

TEST(GasForces, CostOfARobotPerStep) {
  std::string limbs;
  for (int i = 0; i < 20; ++i) {
    limbs +=
        "<body pos=\"0 " + std::to_string(0.05 * i) +
        " 1\"><freejoint/><geom size=\".05\" mass=\".05\" contype=\"0\" conaffinity=\"0\"/></body>";
  }
  Stream stream(ball_model(1.5e-3, 0.02, "0 0 0", limbs.c_str()), {0, 0, 1});
  const auto air = [&](size_t) -> const MediumField& { return stream.field; };
  double best = 1e9;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int64_t n = 0; n < 2000; ++n) {
      stream.forces->begin_step(n + 2000 * round, stream.model, *stream.data, air);
    }
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / 2000);
  }
  printf("forces of air on 21 bodies: %.2f us a step\n", best);
  EXPECT_LT(best, 60) << "us a step";
}

}  // namespace
}  // namespace gloam

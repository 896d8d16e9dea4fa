// The memory of actuator models: resets, checkpoints, recompiles, hashes.

#include <gtest/gtest.h>

#include <cmath>

#include "actuator_rig.h"

namespace gloam {
namespace {

// Every model but the network.
RobotOptions everything() {
  const ActuatorOptions actuator{
      .gear_ratio = 6,
      .stall_torque = 0.5,
      .no_load_speed = 120,
      .torque_limit = 2.5,
      .torque_constant = 0.1,
      .winding_resistance = 0.2,
      .delay = 0.004,
      .backlash = 0.02,
      .friction = ActuatorFriction{.coulomb = 0.1, .breakaway = 0.2, .viscous = 0.01},
      .thermal = MotorThermal{.thermal_resistance = 2, .heat_capacity = 0.5}};
  return {.actuators = SharedActuatorOptions{.battery = BatteryOptions{.voltage = 24,
                                                                       .internal_resistance = 0.2,
                                                                       .capacity = 0.01},
                                             .idle_power = 3},
          .actuator = {actuator}};
}

const Wheel kWheel{.inertia = 0.05, .armature = 0.01};

void drive(ActuatorRig* rig, int from, int to) {
  for (int i = from; i < to; ++i) {
    rig->command(3 * std::sin(0.02 * i));
    rig->step();
  }
}

void expect_same(const ActuatorRig& a, const ActuatorRig& b) {
  EXPECT_EQ(a.position(), b.position());
  EXPECT_EQ(a.speed(), b.speed());
  const ActuatorOutputs x = a.outputs(), y = b.outputs();
  EXPECT_EQ(x.voltage, y.voltage);
  EXPECT_EQ(x.charge, y.charge);
  EXPECT_EQ(x.energy, y.energy);
  EXPECT_EQ(x.drives[0].temperature, y.drives[0].temperature);
  EXPECT_EQ(x.drives[0].force, y.drives[0].force);
}

TEST(ActuatorState, ARunRepeatsItselfToTheBit) {
  ActuatorRig a(kWheel, everything()), b(kWheel, everything());
  drive(&a, 0, 800);
  drive(&b, 0, 800);
  expect_same(a, b);
  EXPECT_EQ(a.sim().latest().hash(), b.sim().latest().hash());
  EXPECT_GT(a.outputs().drives[0].temperature, 21);
}

TEST(ActuatorState, AResetForgetsEverything) {
  ActuatorRig used(kWheel, everything()), fresh(kWheel, everything());
  drive(&used, 0, 500);
  ASSERT_TRUE(used.sim().reset().ok());
  EXPECT_EQ(used.sim().latest().hash(), fresh.sim().latest().hash());
  drive(&used, 0, 300);
  drive(&fresh, 0, 300);
  expect_same(used, fresh);
  EXPECT_EQ(used.sim().latest().hash(), fresh.sim().latest().hash());
}

TEST(ActuatorState, ACheckpointGoesOnToTheBit) {
  ActuatorRig rig(kWheel, everything());
  drive(&rig, 0, 400);
  auto checkpoint = rig.sim().checkpoint();
  ASSERT_TRUE(checkpoint.ok());
  EXPECT_NE((*checkpoint)->copy, nullptr) << "actuator models can be copied";
  drive(&rig, 400, 800);
  ActuatorRig other(kWheel, everything());
  drive(&other, 0, 800);
  const uint64_t hash = rig.sim().latest().hash();
  EXPECT_EQ(hash, other.sim().latest().hash()) << "a checkpoint changes nothing";
  ASSERT_TRUE(rig.sim().restore(**checkpoint).ok());
  drive(&rig, 400, 800);
  expect_same(rig, other);
  EXPECT_EQ(rig.sim().latest().hash(), hash);

  CheckpointData stepped = **checkpoint;  // as where it cannot be copied
  stepped.copy.reset();
  ASSERT_TRUE(rig.sim().restore(stepped).ok());
  drive(&rig, 400, 800);
  expect_same(rig, other);
  EXPECT_EQ(rig.sim().latest().hash(), hash);
}

TEST(ActuatorState, ARecompileGoesOnToTheBit) {
  ActuatorRig changed(kWheel, everything()), plain(kWheel, everything());
  drive(&changed, 0, 300);
  drive(&plain, 0, 300);
  const auto again = wheel_world(kWheel, everything());
  ASSERT_TRUE(changed.sim().recompile(again, robots_of(again)).ok());
  drive(&changed, 300, 600);
  drive(&plain, 300, 600);
  expect_same(changed, plain);
}

TEST(ActuatorState, IsInTheHash) {
  ActuatorRig cool(kWheel, everything());
  RobotOptions warm_options = everything();
  warm_options.actuator[0].thermal->ambient = 30;
  ActuatorRig warm(kWheel, warm_options);
  cool.step();
  warm.step();
  EXPECT_EQ(cool.speed(), warm.speed());
  EXPECT_NE(cool.sim().latest().hash(), warm.sim().latest().hash())
      << "another temperature is another future";
}

TEST(ActuatorState, RobotsWithoutActuatorsHaveNoLayer) {
  const auto world = wheel_world(kWheel, {});
  const auto none = make_actuators(*world, world->robots[0]);
  ASSERT_TRUE(none.ok());
  EXPECT_EQ(*none, nullptr);
}

// MuJoCo replaces controls that are no numbers by zero and warns; so it is with models.
TEST(ActuatorState, ABadControlIsLeftToMujoco) {
  ActuatorRig rig(kWheel, everything());
  ASSERT_TRUE(rig.sim()
                  .set_step_hook([](const mjModel*, mjData* data) { data->ctrl[0] = std::nan(""); })
                  .ok());
  rig.step(10);
  EXPECT_EQ(rig.speed(), 0);
  EXPECT_GT(rig.sim().counters().warnings[mjWARN_BADCTRL], 0);
}

}  // namespace
}  // namespace gloam

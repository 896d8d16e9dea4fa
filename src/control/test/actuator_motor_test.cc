// Torque-speed curves, limits, delays and gear ratios against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "actuator_rig.h"

namespace gloam {
namespace {

constexpr double kSaturating = 1e4;  // a torque that every limit cuts [N m]

// I dw/dt = stall (1 − w / w0): w = w0 (1 − exp(−t / T)) with T = I w0 / stall.
TEST(DcMotor, SpinsUpExponentially) {
  const Wheel wheel{.inertia = 0.05, .timestep = 1e-4};
  ActuatorRig rig(wheel, ActuatorOptions{.stall_torque = 2, .no_load_speed = 10});
  rig.command(kSaturating);
  const double time_constant = wheel.inertia * 10 / 2;
  for (int i = 1; i <= 10; ++i) {
    rig.step(1000);
    const double t = 1000 * i * wheel.timestep;
    EXPECT_NEAR(rig.speed(), 10 * (1 - std::exp(-t / time_constant)), 2e-3) << t;
    // MuJoCo's Euler steps make of it a geometric series, exactly.
    const double series = std::pow(1 - wheel.timestep / time_constant, 1000 * i);
    EXPECT_NEAR(rig.speed(), 10 * (1 - series), 1e-9);
  }
}

TEST(DcMotor, TurnsAtTheIntersectionWithTheLoad) {
  for (const double load : {0.0, 0.5, 1.5}) {
    ActuatorRig rig(Wheel{}, ActuatorOptions{.stall_torque = 2, .no_load_speed = 10});
    rig.command(kSaturating);
    rig.load(-load);
    rig.step(5000);
    EXPECT_NEAR(rig.speed(), 10 * (1 - load / 2), 1e-6) << load;
    EXPECT_NEAR(rig.force(), load, 1e-6);
  }
}

TEST(DcMotor, OnlyBrakesBeyondItsNoLoadSpeed) {
  ActuatorRig rig(Wheel{.speed = 15},
                  ActuatorOptions{.stall_torque = 2, .no_load_speed = 10, .torque_limit = 1.5});
  rig.command(kSaturating);
  rig.step();
  EXPECT_DOUBLE_EQ(rig.outputs().drives[0].force, 2 * (1 - 1.5));
  rig.command(-kSaturating);
  rig.step();
  EXPECT_DOUBLE_EQ(rig.outputs().drives[0].force, -1.5) << "the torque limit holds for braking";
}

TEST(DcMotor, CommandsWithinTheLimitsAreAppliedToTheBit) {
  ActuatorRig rig(Wheel{}, ActuatorOptions{.stall_torque = 2, .no_load_speed = 10}),
      bare(Wheel{}, ActuatorOptions{});
  for (ActuatorRig* one : {&rig, &bare}) {
    one->command(0.7);
    one->step(100);
  }
  EXPECT_EQ(rig.speed(), bare.speed());
  EXPECT_EQ(rig.outputs().drives[0].force, 0.7);
}

TEST(TorqueTable, DrivesByInterpolationAndBrakesWithTheTorqueOfRest) {
  const ActuatorOptions table{.curve = {{0, 3}, {10, 3}, {20, 0}}};
  ActuatorRig rig(Wheel{}, table);
  rig.command(kSaturating);
  rig.load(-1.2);  // the torque at 16 rad/s
  rig.step(8000);
  EXPECT_NEAR(rig.speed(), 16, 1e-6);
  rig.command(-kSaturating);
  rig.step();
  EXPECT_NEAR(rig.outputs().drives[0].force, -3, 1e-12);
  ActuatorRig fast(Wheel{.speed = 25}, table);
  fast.command(kSaturating);
  fast.step();
  EXPECT_EQ(fast.outputs().drives[0].force, 0) << "beyond the last row its torque holds";
}

TEST(Actuators, CommandsStayVisibleAndForcesAreTheAppliedOnes) {
  ActuatorRig rig(Wheel{}, ActuatorOptions{.torque_limit = 1.25});
  rig.command(4);
  rig.step(10);
  EXPECT_EQ(rig.sim().latest().control(Actuator{0}), 4);
  EXPECT_EQ(rig.force(), 1.25);
  EXPECT_NEAR(rig.speed(), 10 * 1e-3 * 1.25 / 0.05, 1e-12);
}

TEST(Actuators, GearsAndGainsOfTheModelAreKept) {
  Wheel geared;
  geared.actuator =
      R"(<general name="wheel" joint="wheel" gear="2" gainprm="3" ctrlrange="-1 1"/>)";
  ActuatorRig rig(geared, ActuatorOptions{.torque_limit = 4.5});
  rig.command(0.5);
  rig.step();
  EXPECT_NEAR(rig.speed(), 1e-3 * (2 * 3 * 0.5) / 0.05, 1e-12);
  rig.command(9);  // limited to 1, which is 6 N m, then to 4.5 N m
  rig.step();
  EXPECT_NEAR(rig.speed(), 1e-3 * (3 + 4.5) / 0.05, 1e-12);
}

TEST(GearRatio, ScalesSpeedAndTorqueOfTheMotor) {
  ActuatorRig motor(Wheel{},
                    ActuatorOptions{.gear_ratio = 8, .stall_torque = 0.25, .no_load_speed = 80}),
      joint(Wheel{}, ActuatorOptions{.stall_torque = 2, .no_load_speed = 10});
  for (ActuatorRig* rig : {&motor, &joint}) {
    rig->command(kSaturating);
    rig->step(300);
  }
  EXPECT_NEAR(motor.speed(), joint.speed(), 1e-12);
  EXPECT_GT(motor.speed(), 5);
}

// A servo's force is its own law; limits cut it, also where that needs a control out of its range.
TEST(Servo, KeepsItsLawWithinTheLimitsOfTheMotor) {
  Wheel wheel;
  wheel.actuator = R"(<position name="wheel" joint="wheel" kp="40" kv="2" ctrlrange="-1 1"/>)";
  ActuatorRig free(wheel, ActuatorOptions{}), limited(wheel, ActuatorOptions{.torque_limit = 3});
  for (ActuatorRig* rig : {&free, &limited}) {
    rig->command(0.8);
    rig->step();
  }
  EXPECT_NEAR(free.outputs().drives[0].force, 32, 1e-12);
  EXPECT_EQ(limited.outputs().drives[0].force, 3);
  EXPECT_NEAR(limited.force(), 3, 1e-12);
  limited.step(10000);
  EXPECT_NEAR(limited.position(), 0.8, 1e-6);
  ActuatorRig running(Wheel{.speed = 30, .actuator = wheel.actuator},
                      ActuatorOptions{.torque_limit = 3});
  running.command(1);
  running.step(400);  // its law asks for a torque beyond any control within the range
  EXPECT_NEAR(running.force(), -3, 1e-12);
  EXPECT_NEAR(running.speed(), 30 - 400 * 1e-3 * 3 / 0.05, 1e-9);
}

TEST(Delay, ShiftsTheResponseByWholeSteps) {
  constexpr int kSteps = 7;
  ActuatorRig late(Wheel{}, ActuatorOptions{.delay = kSteps * 1e-3}),
      prompt(Wheel{}, ActuatorOptions{});
  std::vector<double> late_speeds, speeds;
  for (int i = 0; i < 100; ++i) {
    for (ActuatorRig* rig : {&late, &prompt}) {
      rig->command(std::sin(0.3 * i));
      rig->step();
    }
    late_speeds.push_back(late.speed());
    speeds.push_back(prompt.speed());
  }
  for (size_t i = 0; i < late_speeds.size(); ++i)
    EXPECT_EQ(late_speeds[i], i < kSteps ? 0 : speeds[i - kSteps]) << i;
}

}  // namespace
}  // namespace gloam

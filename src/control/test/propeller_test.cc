// Propellers on motors against closed forms: thrust, torque, motor limits, battery, memory.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "actuator_rig.h"
#include "robot_world.h"
#include "trot_robots.h"

namespace gloam {
namespace {

constexpr double kThrustFactor = 2e-5,
                 kTorquePerThrust = 0.02;  // [N s²/rad²], [m]: torque per thrust
constexpr double kTorqueFactor = kTorquePerThrust * kThrustFactor;  // [N m s²/rad²]
constexpr double kBladeCircle = 0.25, kShaftInertia = 8e-5;
constexpr double kMotorConstant = 0.0125, kMotorWinding = 0.07;  // [N m/A], [ohm]

PropellerOptions plain_propeller() {
  PropellerOptions o{.diameter = kBladeCircle, .inertia = kShaftInertia, .response_time = 0.03};
  o.thrust_coefficient =
      kThrustFactor * 4 * M_PI * M_PI / (o.air_density * std::pow(kBladeCircle, 4));
  return o;
}

ActuatorOptions driven(const PropellerOptions& propeller) {
  return {.actuators = "thrust", .propeller = propeller};
}

ActuatorOptions motor_driven(const PropellerOptions& propeller) {
  ActuatorOptions options = driven(propeller);
  options.torque_constant = kMotorConstant;
  options.winding_resistance = kMotorWinding;
  return options;
}

// A body on a vertical slide that a propeller pushes.
struct Stand {
  double mass = 1e9;  // [kg]; it hardly changes its speed
  double speed = 0;   // upwards [m/s]
  double wind = 0;    // upwards [m/s]
  double timestep = 1e-3;
  std::string actuator = R"(<motor name="thrust" site="hub" gear="0 0 1 0 0 -0.02"/>)";
};

std::shared_ptr<CompiledWorld> stand_world(const Stand& stand, const RobotOptions& options) {
  RobotOptions named = options;
  named.name = "rig";
  auto world = make_robot_world(
      fmt::format(
          R"(<mujoco><option timestep="{}" gravity="0 0 0" wind="0 0 {}"/><worldbody><body name="stand">
           <joint name="slide" type="slide" axis="0 0 1"/><geom size=".1" mass="{}"/>
           <site name="hub" pos="0.3 0 0.1"/></body></worldbody>
         <actuator>{}</actuator><keyframe><key qpos="0" qvel="{}"/></keyframe></mujoco>)",
          stand.timestep, stand.wind, stand.mass, stand.actuator, stand.speed),
      std::move(named));
  world->initial_key = 0;
  return world;
}

class StandRig {
 public:
  StandRig(const Stand& stand, const RobotOptions& options) : world_(stand_world(stand, options)) {
    const ActuatorMaker make = [](const CompiledWorld& world, const RobotInstance& robot) {
      return make_actuators(world, robot);
    };
    auto sim = Simulator::create(world_, {.pace = Pace::kLockstep, .makers = {{}, make}});
    EXPECT_TRUE(sim.ok());
    sim_ = std::move(*sim);
    const Status added = sim_->add_robot(std::move(robots_of(world_)[0]));
    EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().to_string());
    sim_->start();
  }
  StandRig(const Stand& stand, const ActuatorOptions& actuator)
      : StandRig(stand, RobotOptions{.actuator = {actuator}}) {}

  void run(double thrust, int64_t steps) {
    EXPECT_TRUE(sim_->post({.what = SetControl{Actuator{0}, thrust}}).ok());
    const Status stepped = sim_->step(steps);
    EXPECT_TRUE(stepped.ok()) << (stepped.ok() ? "" : stepped.error().to_string());
  }
  ActuatorOutputs outputs() const { return sim_->latest().data().actuators.at(0); }
  DriveOutput drive() const { return outputs().drives.at(0); }
  uint64_t hash() const { return sim_->latest().hash(); }
  Simulator& sim() { return *sim_; }

 private:
  std::shared_ptr<CompiledWorld> world_;
  std::unique_ptr<Simulator> sim_;
};

TEST(Propeller, ApproachesTheSpeedOfTheCommandedThrustExponentially) {
  StandRig rig({}, driven(plain_propeller()));
  const double wanted = std::sqrt(4 / kThrustFactor);
  for (int i = 1; i <= 100; ++i) {
    rig.run(4, 1);
    const auto at = [&](int step) { return wanted * -std::expm1(-step * 1e-3 / 0.03); };
    EXPECT_NEAR(rig.drive().speed, 0.5 * (at(i - 1) + at(i)), 1e-9 * wanted);
    EXPECT_NEAR(rig.drive().force, kThrustFactor * std::pow(rig.drive().speed, 2), 1e-12);
  }
  rig.run(4, 1000);
  EXPECT_NEAR(rig.drive().force, 4, 1e-9);
  EXPECT_NEAR(rig.outputs().power, kTorqueFactor * std::pow(wanted, 3), 1e-6)
      << "torque times speed";
  rig.run(-1, 1000);
  EXPECT_NEAR(rig.drive().force, 0, 1e-9) << "it does not turn backwards";
}

TEST(Propeller, ThrustAndTorqueFallLinearlyWithTheAdvanceRatio) {
  PropellerOptions o = plain_propeller();
  o.zero_thrust_advance = 0.6;
  o.zero_torque_advance = 0.9;
  const double n = std::sqrt(4 / kThrustFactor) / (2 * M_PI);
  for (const double advance : {-0.2, 0.0, 0.15, 0.3, 0.6, 0.75}) {
    const double power = (1 - advance / 0.9) * kTorquePerThrust * 4 * 2 * M_PI * n;
    StandRig climbing({.speed = advance * n * kBladeCircle}, driven(o));
    climbing.run(4, 2000);
    EXPECT_NEAR(climbing.drive().force, 4 * (1 - advance / 0.6), 1e-6) << advance;
    EXPECT_NEAR(climbing.outputs().power, power, 1e-6 * n) << advance;
    StandRig blown({.wind = -advance * n * kBladeCircle}, driven(o));
    blown.run(4, 2000);
    EXPECT_NEAR(blown.drive().force, 4 * (1 - advance / 0.6), 1e-6) << "wind along the shaft";
  }
}

// U = k w + R (k_Q w² / k + i_0).
TEST(Propeller, TheVoltageLimitsItsSpeed) {
  PropellerOptions o = plain_propeller();
  o.voltage = 10;
  o.no_load_current = 0.5;
  StandRig rig({}, motor_driven(o));
  rig.run(100, 3000);
  const DriveOutput out = rig.drive();
  EXPECT_NEAR(out.current, kTorqueFactor * out.speed * out.speed / kMotorConstant + 0.5, 1e-6);
  EXPECT_NEAR(kMotorConstant * out.speed + kMotorWinding * out.current, 10, 1e-6);
  EXPECT_NEAR(rig.outputs().power, 10 * out.current, 1e-5);
  EXPECT_LT(out.force, 100);
}

// I dw/dt = k i − k_Q w² from rest: w = w_end tanh(t k i / (I w_end)).
TEST(Propeller, TheCurrentLimitsItsAcceleration) {
  PropellerOptions o = plain_propeller();
  o.voltage = 100;
  o.current_limit = 8;
  o.response_time = 1e-3;
  StandRig rig({.timestep = 1e-4}, motor_driven(o));
  const double torque = kMotorConstant * 8, end = std::sqrt(torque / kTorqueFactor);
  for (int i = 1; i <= 10; ++i) {
    rig.run(100, 100);
    const double t = (100 * i - 0.5) * 1e-4;
    EXPECT_NEAR(rig.drive().speed, end * std::tanh(t * torque / (kShaftInertia * end)), 2e-3 * end);
    EXPECT_NEAR(rig.drive().current, 8, 0.05);
  }
}

TEST(Propeller, TheSpeedControllerBrakesAtNoLessThanZeroVolts) {
  PropellerOptions o = plain_propeller();
  o.voltage = 20;
  o.response_time = 1e-4;  // it would stop at once
  StandRig rig({.timestep = 1e-4}, motor_driven(o));
  rig.run(4, 20000);
  const double before = rig.drive().speed;
  rig.run(0, 1);
  const DriveOutput out = rig.drive();
  EXPECT_NEAR(out.current, -kMotorConstant * before / kMotorWinding,
              0.01 * kMotorConstant * before / kMotorWinding);
  EXPECT_LT(std::abs(rig.outputs().power), 0.01 * before * kMotorConstant * std::abs(out.current));
}

RobotOptions on_battery(const PropellerOptions& propeller, const BatteryOptions& battery) {
  return {.actuators = SharedActuatorOptions{.battery = battery},
          .actuator = {motor_driven(propeller)}};
}

TEST(Propeller, ASaggingBatteryLimitsItsSpeed) {
  const BatteryOptions battery{.voltage = 12, .internal_resistance = 0.1, .capacity = 1e4};
  StandRig rig({}, on_battery(plain_propeller(), battery));
  rig.run(100, 5000);
  const ActuatorOutputs out = rig.outputs();
  EXPECT_NEAR(out.voltage, 12 - 0.1 * out.current, 1e-9);
  EXPECT_GT(out.current, 5);
  EXPECT_NEAR(kMotorConstant * out.drives[0].speed + kMotorWinding * out.drives[0].current,
              out.voltage, 1e-5);
  EXPECT_NEAR(out.voltage * out.current, out.power, 1e-9);
}

// A motor without current: I dw/dt = −k_Q w², so w = w_0 / (1 + k_Q w_0 t / I).
TEST(Propeller, RunsDownWhenTheBatteryIsEmpty) {
  const BatteryOptions battery{.voltage = 12, .capacity = 0.01};
  StandRig rig({}, on_battery(plain_propeller(), battery));
  rig.run(4, 20);
  int steps = 0;
  while (rig.outputs().voltage > 0 && ++steps < 5000) rig.run(4, 20);
  rig.run(4, 1);
  const double before = rig.drive().speed;
  EXPECT_LT(rig.drive().current, 1e-9);
  rig.run(4, 400);
  EXPECT_NEAR(rig.drive().speed, before / (1 + kTorqueFactor * before * 0.4 / kShaftInertia),
              1e-3 * before);
}

// Electrical energy = work on the air + heat + friction + kinetic energy of the shaft.
TEST(Propeller, ItsEnergyIsInBalance) {
  PropellerOptions o = plain_propeller();
  o.voltage = 15;
  o.no_load_current = 0.4;
  StandRig rig({}, motor_driven(o));
  double air = 0, heat = 0, friction = 0;
  for (int i = 0; i < 300; ++i) {
    rig.run(i < 150 ? 2 : 5, 1);
    const DriveOutput out = rig.drive();
    air += 1e-3 * kTorqueFactor * std::pow(out.speed, 3);
    heat += 1e-3 * kMotorWinding * out.current * out.current;
    friction += 1e-3 * kMotorConstant * 0.4 * out.speed;
  }
  rig.run(2, 1000);
  const double before = rig.outputs().energy;
  rig.run(2, 1000);
  const DriveOutput out = rig.drive();
  const double steady = kTorqueFactor * std::pow(out.speed, 3) +
                        kMotorWinding * out.current * out.current +
                        kMotorConstant * 0.4 * out.speed;
  EXPECT_NEAR(rig.outputs().energy - before, steady, 1e-6 * steady);

  StandRig again({}, motor_driven(o));
  for (int i = 0; i < 300; ++i) again.run(i < 150 ? 2 : 5, 1);
  const double shaft = 0.5 * kShaftInertia * std::pow(again.drive().speed, 2);
  EXPECT_NEAR(again.outputs().energy, air + heat + friction + shaft, 2e-3 * air);
}

RobotOptions all_of_it() {
  PropellerOptions o = plain_propeller();
  o.zero_thrust_advance = 0.6;
  o.zero_torque_advance = 0.9;
  o.no_load_current = 0.4;
  o.current_limit = 20;
  RobotOptions options =
      on_battery(o, {.voltage = 12, .internal_resistance = 0.05, .capacity = 0.05});
  options.actuator[0].delay = 0.004;
  return options;
}

void vary_thrust(StandRig* rig, int from, int to) {
  for (int i = from; i < to; ++i) rig->run(5 + 4 * std::sin(0.05 * i), 1);
}

TEST(PropellerState, ResetsCheckpointsAndRecompilesGoOnToTheBit) {
  const Stand stand{.mass = 0.4};
  StandRig plain(stand, all_of_it()), rig(stand, all_of_it());
  vary_thrust(&rig, 0, 300);
  ASSERT_TRUE(rig.sim().reset().ok());
  EXPECT_EQ(rig.hash(), plain.hash());
  vary_thrust(&rig, 0, 200);
  auto checkpoint = rig.sim().checkpoint();
  ASSERT_TRUE(checkpoint.ok());
  EXPECT_NE((*checkpoint)->copy, nullptr);
  vary_thrust(&rig, 200, 400);
  vary_thrust(&plain, 0, 400);
  const uint64_t hash = plain.hash();
  EXPECT_EQ(rig.hash(), hash);
  ASSERT_TRUE(rig.sim().restore(**checkpoint).ok());
  vary_thrust(&rig, 200, 400);
  EXPECT_EQ(rig.hash(), hash);
  const auto again = stand_world(stand, all_of_it());
  ASSERT_TRUE(rig.sim().recompile(again, robots_of(again)).ok());
  vary_thrust(&rig, 400, 500);
  vary_thrust(&plain, 400, 500);
  EXPECT_EQ(rig.drive().speed, plain.drive().speed);
  EXPECT_EQ(rig.drive().force, plain.drive().force);
  EXPECT_EQ(rig.outputs().charge, plain.outputs().charge);
  EXPECT_EQ(rig.sim().latest()[Joint{0}].velocity(), plain.sim().latest()[Joint{0}].velocity());
}

TEST(PropellerState, ItsSpeedIsInTheHash) {
  PropellerOptions slow = plain_propeller();
  slow.response_time = 0.031;
  StandRig one({}, driven(plain_propeller())), other({}, driven(slow));
  one.run(0, 1);
  other.run(0, 1);
  EXPECT_EQ(one.hash(), other.hash()) << "both are at rest";
  // In the step of a command only the memory differs: the mass is too large for another velocity.
  one.run(4, 1);
  other.run(4, 1);
  EXPECT_NE(one.hash(), other.hash());
}

TEST(Propeller, ErrorsNameTheActuator) {
  const auto error = [](const Stand& stand, const ActuatorOptions& actuator) {
    const auto world = stand_world(stand, RobotOptions{.actuator = {actuator}});
    auto layer = make_actuators(*world, world->robots[0]);
    Status status = layer.ok() ? (*layer)->begin(*world->model, {1, 500}) : Status(layer.error());
    return status.ok() ? "" : status.error().to_string();
  };
  ActuatorOptions other = driven(plain_propeller());
  other.actuators = "thrus";
  EXPECT_NE(error({}, other).find("no actuator at a site of robot 'rig' matches 'thrus'"),
            std::string::npos);
  EXPECT_NE(error({}, other).find("thrust"), std::string::npos) << "the nearest name";
  const Stand lagging{.actuator = R"(<general name="thrust" site="hub" gear="0 0 1 0 0 0"
                                       dyntype="filterexact" dynprm="0.03"/>)"};
  EXPECT_NE(error(lagging, driven(plain_propeller())).find("activation"), std::string::npos);
  const Stand twist{.actuator = R"(<motor name="thrust" site="hub" gear="0 0 0 0 0 1"/>)"};
  EXPECT_NE(error(twist, driven(plain_propeller())).find("no thrust"), std::string::npos);
  const Stand free{.actuator = R"(<motor name="thrust" site="hub" gear="0 0 1 0 0 0"/>)"};
  EXPECT_NE(error(free, motor_driven(plain_propeller())).find("power_coefficient"),
            std::string::npos);
}

}  // namespace
}  // namespace gloam

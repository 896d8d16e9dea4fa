// Battery, winding temperature and energy against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "actuator_rig.h"

namespace gloam {
namespace {

constexpr double kFull = 1e4;                      // [N m]
constexpr double kConstant = 0.1, kWinding = 0.2;  // [N m/A], [ohm]
// A wheel that hardly moves, so that a torque is a constant current.
const Wheel kHeavy{.inertia = 1e9, .timestep = 2e-3};

RobotOptions with_battery(const ActuatorOptions& actuator, const BatteryOptions& battery,
                          double idle_power = 0) {
  return {.actuators = SharedActuatorOptions{.battery = battery, .idle_power = idle_power},
          .actuator = {actuator}};
}

TEST(Battery, SagsByItsInternalResistance) {
  const ActuatorOptions motor{.torque_constant = kConstant, .winding_resistance = kWinding};
  ActuatorRig rig(kHeavy,
                  with_battery(motor, {.voltage = 24, .internal_resistance = 0.3, .capacity = 2}));
  rig.command(1.5);  // 15 A through the winding, 45 W
  rig.step(1000);
  const ActuatorOutputs out = rig.outputs();
  EXPECT_NEAR(out.drives[0].current, 15, 1e-12);
  EXPECT_NEAR(out.power, 45, 1e-6);
  EXPECT_NEAR(out.voltage, 24 - 0.3 * out.current, 1e-12);
  EXPECT_NEAR(out.voltage * out.current, out.power, 1e-9);
  EXPECT_NEAR(out.energy, 45 * 2.0, 1e-6);
  EXPECT_NEAR(out.charge, 1 - out.current * 2.0 / (2 * 3600), 1e-9);
  EXPECT_DOUBLE_EQ(out.capacity, 2);
}

// Steady: stall (V / Vn − w / w0) = load, V = V0 − I R, I V = load · w + i² R_w.
TEST(Battery, SagLowersTheSpeedUnderLoad) {
  constexpr double kLoad = 1;
  const ActuatorOptions motor{.stall_torque = 2,
                              .no_load_speed = 100,
                              .torque_constant = kConstant,
                              .winding_resistance = kWinding};
  ActuatorRig rig(Wheel{}, with_battery(motor, {.voltage = 24,
                                                .nominal_voltage = 25,
                                                .internal_resistance = 0.5,
                                                .capacity = 1e4}));
  rig.command(kFull);
  rig.load(-kLoad);
  rig.step(60000);
  const ActuatorOutputs out = rig.outputs();
  EXPECT_NEAR(out.voltage, 24 - 0.5 * out.current, 1e-9);
  EXPECT_NEAR(rig.speed(), 100 * (out.voltage / 25 - kLoad / 2), 1e-5);
  EXPECT_NEAR(out.voltage * out.current, kLoad * rig.speed() + 100 * kWinding, 1e-4);
  EXPECT_LT(rig.speed(), 100 * (24.0 / 25 - kLoad / 2)) << "without the internal resistance";
}

TEST(Battery, FollowsItsCurveAndSwitchesOffWhenItIsEmpty) {
  const ActuatorOptions motor{.stall_torque = 2,
                              .no_load_speed = 100,
                              .torque_constant = kConstant,
                              .winding_resistance = kWinding};
  const BatteryOptions battery{
      .curve = {{0, 20}, {0.5, 24}, {1, 25}}, .capacity = 0.01, .charge = 0.5};
  ActuatorRig rig(kHeavy, with_battery(motor, battery));
  EXPECT_DOUBLE_EQ(rig.outputs().voltage, 24);
  rig.command(1);  // 20 W of 18 A s
  rig.step(2500);
  const ActuatorOutputs half = rig.outputs();
  EXPECT_NEAR(half.voltage, 20 + 8 * half.charge, 1e-3);
  EXPECT_NEAR(half.drives[0].force, 1, 1e-12);
  rig.step(20000);
  EXPECT_EQ(rig.outputs().charge, 0);
  EXPECT_EQ(rig.outputs().voltage, 0);
  EXPECT_EQ(rig.outputs().drives[0].force, 0);
}

TEST(Battery, IsChargedByBrakingMotorsIfItMayBe) {
  const ActuatorOptions motor{.torque_constant = kConstant, .winding_resistance = 1e-3};
  const BatteryOptions battery{.voltage = 24, .capacity = 1, .charge = 0.5};
  BatteryOptions one_way = battery;
  one_way.regenerates = false;
  const Wheel wheel{.inertia = 1, .speed = 50};
  ActuatorRig back(wheel, with_battery(motor, battery)),
      lost(wheel, with_battery(motor, one_way, 5));
  for (ActuatorRig* rig : {&back, &lost}) {
    rig->command(-1);
    rig->step(1000);
  }
  EXPECT_GT(back.outputs().charge, 0.5);
  EXPECT_NEAR(back.outputs().energy, -49.5 + 0.1, 0.06) << "∫ τ w dt + i² R t";
  EXPECT_NEAR(lost.outputs().energy, 5, 1e-9) << "the idle power alone";
}

// C dT/dt = P − (T − T_air) / R_th from T_air: T = T_air + P R_th (1 − exp(−t / R_th C)).
TEST(WindingHeat, RisesExponentiallyToItsSteadyTemperature) {
  const ActuatorOptions motor{.torque_limit = 100,
                              .torque_constant = kConstant,
                              .winding_resistance = kWinding,
                              .thermal = MotorThermal{.thermal_resistance = 1.5,
                                                      .heat_capacity = 20,
                                                      .derate_start = 400,
                                                      .cutoff = 500,
                                                      .ambient = 25}};
  ActuatorRig rig(kHeavy, motor);
  rig.command(1.5);  // 45 W
  for (int i = 1; i <= 5; ++i) {
    rig.step(5000);
    const double t = 5000 * i * 2e-3;
    EXPECT_NEAR(rig.outputs().drives[0].temperature, 25 + 67.5 * (1 - std::exp(-t / 30)), 1e-8);
  }
  rig.step(500000);
  EXPECT_NEAR(rig.outputs().drives[0].temperature, 25 + 45 * 1.5, 1e-8);
}

// Steady: torque = limit · (cutoff − T) / (cutoff − start) and T = T_air + R_th R (torque / k)².
TEST(WindingHeat, LowersTheTorqueToWhatTheWindingStands) {
  const ActuatorOptions motor{
      .torque_limit = 3,
      .torque_constant = kConstant,
      .winding_resistance = kWinding,
      .thermal = MotorThermal{.thermal_resistance = 1, .heat_capacity = 10}};
  ActuatorRig rig(kHeavy, motor);
  rig.command(kFull);
  rig.step();
  EXPECT_DOUBLE_EQ(rig.outputs().drives[0].force, 3);
  rig.step(200000);
  const DriveOutput out = rig.outputs().drives[0];
  EXPECT_NEAR(out.temperature, 20 + kWinding * std::pow(out.force / kConstant, 2), 1e-6);
  EXPECT_NEAR(out.force, 3 * (100 - out.temperature) / 20, 1e-6);
}

TEST(WindingHeat, StartsAtTheTemperatureOfTheScenesAir) {
  const ActuatorOptions motor{
      .torque_limit = 3,
      .torque_constant = kConstant,
      .winding_resistance = kWinding,
      .thermal = MotorThermal{.thermal_resistance = 1, .heat_capacity = 10}};
  const auto world = wheel_world(kHeavy, RobotOptions{.actuator = {motor}});
  GasDescription air;
  air.temperature = 313.15F;
  world->gases.gases.push_back(air);
  auto layer = make_actuators(*world, world->robots[0]);
  ASSERT_TRUE(layer.ok() && (*layer)->begin(*world->model, {1, 500}).ok());
  const DataPtr data(mj_makeData(world->model.get()));
  (*layer)->reset(*world->model, *data);
  ActuatorOutputs out;
  (*layer)->publish(&out);
  EXPECT_NEAR(out.drives.at(0).temperature, 40, 1e-4);
}

// Electrical energy = heat of the winding + friction + kinetic energy.
TEST(ElectricPower, IsInBalanceWithHeatFrictionAndMotion) {
  const Wheel wheel{.inertia = 0.05, .timestep = 1e-5};
  const ActuatorOptions motor{.gear_ratio = 5,
                              .stall_torque = 0.4,
                              .no_load_speed = 60,
                              .torque_constant = kConstant,
                              .winding_resistance = kWinding,
                              .friction = ActuatorFriction{.coulomb = 0.3, .viscous = 0.05}};
  ActuatorRig rig(wheel, RobotOptions{.actuator = {motor}});
  rig.command(kFull);
  double heat = 0, rubbed = 0;
  for (int i = 0; i < 100000; ++i) {
    const double v = rig.speed();
    rig.step();
    const DriveOutput out = rig.outputs().drives[0];
    heat += wheel.timestep * out.current * out.current * kWinding;
    rubbed += wheel.timestep * v * (5 * out.current * kConstant - out.force);
  }
  const double motion = 0.5 * wheel.inertia * rig.speed() * rig.speed();
  EXPECT_GT(motion, 1);
  EXPECT_GT(rubbed, 1);
  EXPECT_NEAR(rig.outputs().energy, heat + rubbed + motion, 1e-3 * rig.outputs().energy);
}

}  // namespace
}  // namespace gloam

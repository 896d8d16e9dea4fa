// Actuator networks: inputs, periods and errors. The networks are functions of the tests.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "actuator_rig.h"

namespace gloam {
namespace {

using Function = std::function<float(std::span<const float>)>;

class TestNetwork final : public ActuatorNetwork {
 public:
  TestNetwork(size_t inputs, Function f) : inputs_(inputs), f_(std::move(f)) {}
  size_t inputs() const override { return inputs_; }
  size_t outputs() const override { return 1; }
  bool evaluate(std::span<const float> inputs, std::span<float> outputs) override {
    outputs[0] = f_(inputs);
    return true;
  }
  std::unique_ptr<ActuatorNetwork> share() const override {
    return std::make_unique<TestNetwork>(inputs_, f_);
  }

 private:
  size_t inputs_;
  Function f_;
};

ActuatorNetworkLoader network_of(const Function& f, size_t inputs = 6) {
  return [f, inputs](const std::filesystem::path&) {
    return Result<std::unique_ptr<ActuatorNetwork>>(std::make_unique<TestNetwork>(inputs, f));
  };
}

// kp e(t) − kd v(t): the law of a servo.
float servo_law(std::span<const float> in) { return 40 * in[0] - 2 * in[3]; }

RobotOptions with_network(const ActuatorNetworkOptions& network) {
  return {.actuator = {ActuatorOptions{.network = network}}};
}

TEST(ActuatorNetwork, OfTheLawOfAServoIsTheServo) {
  Wheel wheel;
  wheel.actuator = R"(<position joint="wheel" kp="40" kv="2"/>)";
  ActuatorRig learned(wheel, with_network({.file = "servo.onnx", .period = 0.001}),
                      network_of(servo_law)),
      servo(wheel, ActuatorOptions{});
  for (ActuatorRig* rig : {&learned, &servo}) {
    rig->command(0.7);
    rig->step(400);
  }
  EXPECT_NEAR(learned.position(), servo.position(), 1e-5);
}

// The torque of a PD controller holds the target: a network has it back from the gains.
TEST(ActuatorNetwork, OfAMotorGetsTheTargetOfTheController) {
  ActuatorRig rig(Wheel{.speed = 1.5},
                  with_network({.file = "a.onnx", .period = 0.001, .kp = 20, .kd = 0.5}),
                  network_of([](std::span<const float> in) { return in[0]; }));
  rig.command(20 * 0.3 - 0.5 * 1.5);
  rig.step();
  EXPECT_NEAR(rig.outputs().drives[0].force, 0.3, 1e-6);
}

TEST(ActuatorNetwork, GetsThreeSamplesAtItsPeriodTheNewestFirst) {
  Wheel wheel{.inertia = 1e9, .speed = 2};
  wheel.actuator = R"(<position joint="wheel" kp="1"/>)";
  std::vector<std::vector<float>> seen;
  ActuatorRig rig(
      wheel,
      with_network(
          {.file = "a.onnx", .position_scale = -1, .velocity_scale = 0.5, .torque_scale = 3}),
      network_of([&](std::span<const float> in) {
        seen.emplace_back(in.begin(), in.end());
        return static_cast<float>(seen.size());
      }));
  for (int i = 0; i < 16; ++i) {
    rig.step();
    EXPECT_NEAR(rig.outputs().drives[0].force, 3.0 * (1 + i / 5), 1e-9) << "held for 5 steps";
  }
  ASSERT_EQ(seen.size(), 4U);
  const std::vector<std::vector<float>> positions = {
      {0, 0, 0}, {0.01F, 0, 0}, {0.02F, 0.01F, 0}, {0.03F, 0.02F, 0.01F}};
  for (size_t i = 0; i < seen.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(seen[i][k], positions[i][k], 1e-6) << "position − target";
      EXPECT_NEAR(seen[i][3 + k], 1, 1e-6);
    }
  }
}

TEST(ActuatorNetwork, MayTakeVelocitiesFirst) {
  Wheel wheel{.speed = 2};
  wheel.actuator = R"(<position joint="wheel" kp="1"/>)";
  ActuatorRig rig(wheel,
                  with_network({.file = "a.onnx", .history = 1, .order = "velocity_position"}),
                  network_of([](std::span<const float> in) { return in[0] + 10 * in[1]; }, 2));
  rig.command(0.3);
  rig.step();
  EXPECT_NEAR(rig.outputs().drives[0].force, 2 + 10 * 0.3, 1e-5);
}

TEST(ActuatorNetwork, ThatReturnsNoNumberEndsTheRunWithAnError) {
  Wheel wheel;
  wheel.actuator = R"(<position joint="wheel" kp="1"/>)";
  int calls = 0;
  ActuatorRig rig(wheel, with_network({.file = "a.onnx"}),
                  network_of([&](std::span<const float>) { return ++calls < 3 ? 1 : NAN; }));
  rig.step(10);
  const double before = rig.position();
  const Status failed = rig.sim().step(1);
  ASSERT_FALSE(failed.ok());
  EXPECT_EQ(failed.error().kind, ErrorKind::kDiverged);
  EXPECT_NE(failed.error().message.find("'wheel' returned a torque that is not finite"),
            std::string::npos)
      << failed.error().message;
  EXPECT_EQ(rig.position(), before) << "the last good state";
}

TEST(ActuatorNetwork, OfAnotherSizeIsRejected) {
  Wheel wheel;
  wheel.actuator = R"(<position joint="wheel" kp="1"/>)";
  const auto world = wheel_world(wheel, with_network({.file = "a.onnx"}));
  auto layer = make_actuators(*world, world->robots[0], network_of(servo_law, 4));
  ASSERT_TRUE(layer.ok());
  const Status begun = (*layer)->begin(*world->model, {1, 1000});
  ASSERT_FALSE(begun.ok());
  EXPECT_NE(begun.error().message.find("4 inputs"), std::string::npos) << begun.error().message;
  EXPECT_NE(begun.error().hint.find("'history'"), std::string::npos);
}

TEST(ActuatorNetwork, OfAPeriodBetweenStepsIsRejected) {
  Wheel wheel;
  wheel.actuator = R"(<position joint="wheel" kp="1"/>)";
  const auto world = wheel_world(wheel, with_network({.file = "a.onnx", .period = 0.0045}));
  auto layer = make_actuators(*world, world->robots[0], network_of(servo_law));
  ASSERT_TRUE(layer.ok());
  const Status begun = (*layer)->begin(*world->model, {1, 1000});
  ASSERT_FALSE(begun.ok());
  EXPECT_NE(begun.error().hint.find("use 0.004 or 0.005"), std::string::npos);
}

// Histories and held torques are memory.
TEST(ActuatorNetwork, GoesOnFromACheckpointToTheBit) {
  Wheel wheel;
  wheel.actuator = R"(<position joint="wheel" kp="1"/>)";
  const auto law = network_of(
      [](std::span<const float> in) { return 30 * in[0] - 10 * in[2] - in[3] - 0.3F * in[5]; });
  ActuatorRig rig(wheel, with_network({.file = "a.onnx"}), law);
  rig.command(0.5);
  rig.step(103);
  auto checkpoint = rig.sim().checkpoint();
  ASSERT_TRUE(checkpoint.ok());
  rig.step(200);
  const uint64_t hash = rig.sim().latest().hash();
  ASSERT_TRUE(rig.sim().restore(**checkpoint).ok());
  rig.step(200);
  EXPECT_EQ(rig.sim().latest().hash(), hash);
}

}  // namespace
}  // namespace gloam

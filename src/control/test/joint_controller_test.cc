// Controllers of single joints against closed forms.

#include <cmath>

#include "joint_rig.h"

namespace gloam {
namespace {

ControllerOptions options(const char* type, double kp, double kd, Rational rate = {1000, 1}) {
  return {.type = type, .rate = rate, .kp = kp, .kd = kd};
}

TEST(JointController, StepResponseIsThatOfASecondOrderSystem) {
  // I q" + kd q' + kp (q - 1) = 0, underdamped: w = 20 1/s, zeta = 0.25.
  const double inertia = 0.1, kp = 40, kd = 1;
  const double w = std::sqrt(kp / inertia), zeta = kd / (2 * std::sqrt(kp * inertia));
  const double wd = w * std::sqrt(1 - zeta * zeta);
  for (const char* type : {"joint_position", "joint_effort"}) {
    auto sim = run_arm(arm_world(kWheel, options(type, kp, kd, {2000, 1})));
    ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {1.0}}}).ok());
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(sim->step(50).ok());
      const double t = sim->latest().time();
      const double q =
          1 - std::exp(-zeta * w * t) * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t));
      EXPECT_NEAR(sim->latest()[Joint{0}].position(), q, 0.01) << type << " at " << t;
    }
  }
}

TEST(JointController, GainsOfACommandReplaceTheOptions) {
  auto sim = run_arm(arm_world(kWheel, options("joint_effort", 40, 1)));
  ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {0.5}, {2}, {3}, {10}, {4}}}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_DOUBLE_EQ(sim->latest().control(Actuator{0}), (10 * 0.5 + 4 * 2 + 3) / 2);  // gear 2
  // NaN takes a target away, an empty vector leaves it.
  ASSERT_TRUE(sim->reset().ok());
  ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {0.5}, {2}, {3}, {10}, {4}}}).ok());
  ASSERT_TRUE(
      sim->post({.what = SetJointCommand{kArmRobot, {{0, 0}}, {std::nan("")}, {}, {1}}}).ok());
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_DOUBLE_EQ(sim->latest().control(Actuator{0}), (4 * 2 + 1) / 2.0);
}

// A finger of grams at the default gains: kd alone would turn it around within a step.
TEST(JointController, LightJointsStayStableAtGainsOfHeavyOnes) {
  constexpr const char* kFinger =
      R"(<mujoco><compiler angle="radian"/><option timestep="0.002" gravity="0 0 0"/><worldbody><body name="hand">
    <geom size=".01"/>
    <body><joint name="1" axis="0 1 0"/><inertial pos=".02 0 0" mass=".005" diaginertia="1e-7 1e-6 1e-6"/>
      <body pos=".04 0 0"><joint name="2" axis="0 1 0"/><inertial pos=".02 0 0" mass=".005" diaginertia="1e-7 1e-6 1e-6"/>
        <body pos=".04 0 0"><joint name="3" axis="0 1 0"/><inertial pos=".02 0 0" mass=".005" diaginertia="1e-7 1e-6 1e-6"/>
    </body></body></body></body></worldbody>
    <actuator><motor joint="1"/><motor joint="2"/><motor joint="3"/></actuator></mujoco>)";
  for (const int rate : {500, 100}) {
    auto sim = run_arm(arm_world(kFinger, options("joint_position", 40, 1, {rate, 1})));
    ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {0.5, -0.3, 0.2}}}).ok());
    ASSERT_TRUE(sim->step(2000).ok());
    const Snapshot now = sim->latest();
    EXPECT_NEAR(now[Joint{0}].position(), 0.5, 0.01) << rate;
    EXPECT_NEAR(now[Joint{1}].position(), -0.3, 0.01) << rate;
    EXPECT_NEAR(now[Joint{2}].position(), 0.2, 0.01) << rate;
  }
}

TEST(JointController, EffortWithoutTargetsIsZero) {
  auto sim = run_arm(arm_world(kPendulums, options("joint_effort", 40, 1)));
  ASSERT_TRUE(sim->step(1).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 0);
  ASSERT_TRUE(sim->step(99).ok());
  // All three fall alike: the servos give no force either.
  const Snapshot now = sim->latest();
  EXPECT_GT(now[Joint{0}].position(), 0.05);
  EXPECT_NEAR(now[Joint{1}].position(), now[Joint{0}].position(), 1e-9);
  EXPECT_NEAR(now[Joint{2}].position(), now[Joint{0}].position(), 1e-9);
}

TEST(JointController, FeedForwardBalancesGravityWithEveryKindOfActuator) {
  auto sim = run_arm(arm_world(kPendulums, options("joint_effort", 0, 0)));
  const double torque = -2 * 9.81 * 0.5;  // about y, horizontal
  ASSERT_TRUE(
      sim->post({.what = SetJointCommand{kArmRobot, {}, {}, {}, {torque, torque, torque}}}).ok());
  ASSERT_TRUE(sim->step(1000).ok());
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(sim->latest()[Joint{j}].position(), 0, 1e-9) << j;
    EXPECT_NEAR(sim->latest()[Joint{j}].velocity(), 0, 1e-9) << j;
  }
}

TEST(JointController, VelocityIsReachedWithoutErrorByTheIntegralOnly) {
  auto world = arm_world(kWheel, options("joint_velocity", 20, 2));
  world->model->dof_damping[0] = 0.5;
  auto sim = run_arm(world);
  ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {}, {3}}}).ok());
  ASSERT_TRUE(sim->step(10'000).ok());
  EXPECT_NEAR(sim->latest()[Joint{0}].velocity(), 3, 1e-6);
  // Without it the damping of the joint takes its share: kd (v* - v) = 0.5 v.
  auto weak_world = arm_world(kWheel, options("joint_velocity", 0, 2));
  weak_world->model->dof_damping[0] = 0.5;
  auto weak = run_arm(weak_world);
  ASSERT_TRUE(weak->post({.what = SetJointCommand{kArmRobot, {}, {}, {3}}}).ok());
  ASSERT_TRUE(weak->step(10'000).ok());
  EXPECT_NEAR(weak->latest()[Joint{0}].velocity(), 3 * 2 / 2.5, 1e-6);
}

TEST(JointController, VelocityDoesNotWindUpWhileTheJointIsBlocked) {
  auto world = arm_world(kWheel, options("joint_velocity", 20, 2));
  world->model->actuator_forcelimited[0] = 1;
  world->model->actuator_forcerange[0] = -1;
  world->model->actuator_forcerange[1] = 1;
  world->model->dof_frictionloss[0] = 10;  // more than 2 N m
  auto sim = run_arm(world);
  ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {}, {3}}}).ok());
  ASSERT_TRUE(sim->step(10'000).ok());
  EXPECT_EQ(sim->latest().control(Actuator{0}), 1);
  ASSERT_TRUE(sim->post({.what = SetJointCommand{kArmRobot, {}, {}, {-3}}}).ok());
  ASSERT_TRUE(sim->step(150).ok());  // 2 N m / 20 N m/rad / 3 rad/s = 33 ms, and as much again
  EXPECT_EQ(sim->latest().control(Actuator{0}), -1);
}

TEST(JointController, ServosGetTheirOwnTargets) {
  auto sim = run_arm(arm_world(kPendulums, options("joint_velocity", 40, 5)));
  ASSERT_TRUE(
      sim->post({.what = SetJointCommand{kArmRobot, {{1, 0}, {2, 0}}, {}, {0.2, 0.4}}}).ok());
  ASSERT_TRUE(sim->step(1000).ok());
  // Integral of the velocity and kv / kp of it ahead: the servo's damping is no lag.
  EXPECT_NEAR(sim->latest().control(Actuator{1}), 0.2 * 1 + 3.0 / 80 * 0.2, 1e-9);
  EXPECT_DOUBLE_EQ(sim->latest().control(Actuator{2}), 0.4);
}

TEST(JointController, BadCommandsAreRejected) {
  auto sim = run_arm(arm_world(kPendulums, options("joint_effort", 40, 1)));
  const auto error = [&](decltype(Command::what) what) {
    const Status status = sim->post({.what = std::move(what)});
    return status.ok() ? std::string("accepted") : status.error().to_string();
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_PRED2(has, error(SetJointCommand{{3, 0}, {}, {1, 1, 1}}), "robot number 3");
  EXPECT_PRED2(has, error(SetJointCommand{kArmRobot, {}, {1}}), "1 values for 3 joints");
  EXPECT_PRED2(has, error(SetJointCommand{kArmRobot, {{0, 0}}, {}, {1, 2}}), "'velocity' has 2");
  EXPECT_PRED2(has, error(SetJointCommand{kArmRobot, {{0, 0}}, {INFINITY}}), "cannot be inf");
  EXPECT_PRED2(has, error(SetJointCommand{kArmRobot, {{0, 0}}, {}, {}, {}, {-1}}), "'kp'");
  EXPECT_PRED2(has, error(SetJointCommand{kArmRobot, {{7, 0}}, {1}}), "joint number 7");
  EXPECT_PRED2(has, error(SetJointCommand{kArmRobot, {{0, 0}, {0, 0}}, {1, 1}}), "listed twice");
  EXPECT_PRED2(has, error(StopTrajectory{{-1, 0}}), "robot number -1");
  EXPECT_EQ(error(SetJointCommand{kArmRobot, {}, {NAN, 0, 0}}), "accepted");
}

}  // namespace
}  // namespace gloam

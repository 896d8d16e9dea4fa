// Controllers "ik" and "osc" on small arms, run through the Simulator.

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "control/controllers.h"
#include "ik_models.h"
#include "scene/files/mujoco_guard.h"
#include "sim/loop/simulator.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

using testing::HasSubstr;
using testing::Not;

std::shared_ptr<CompiledWorld> task_world(const std::string& xml, ControllerOptions options) {
  install_mujoco_handler();
  auto world = std::make_shared<CompiledWorld>();
  world->model = compile_model(xml);
  RobotInstance robot;
  robot.name = "arm";
  robot.root_body = mj_name2id(world->model.get(), mjOBJ_BODY, "upper");
  robot.options.controller = std::move(options);
  world->robots.push_back(robot);
  return world;
}

ControllerOptions task_options(const char* type, Rational rate = {500, 1}) {
  ControllerOptions options{.type = type, .rate = rate};
  options.task.frame = "site tip";
  options.task.orientation_cost = 0;
  options.task.orientation_stiffness = 0;
  return options;
}

std::unique_ptr<Simulator> start_task(const std::shared_ptr<CompiledWorld>& world) {
  auto controller = make_controller(world, world->robots[0]);
  EXPECT_TRUE(controller.ok()) << controller.error().to_string();
  auto sim = Simulator::create(world, {.pace = Pace::kLockstep});
  EXPECT_TRUE(sim.ok());
  const Rational rate = world->robots[0].options.controller.rate;
  EXPECT_TRUE((*sim)->add_controller(0, std::move(*controller), rate).ok());
  (*sim)->start();
  return std::move(*sim);
}

void set_joints(Simulator& sim, double q1, double q2) {
  ASSERT_TRUE(sim.post({.what = SetJointState{Joint{0}, {q1}, {0}}}).ok());
  ASSERT_TRUE(sim.post({.what = SetJointState{Joint{1}, {q2}, {0}}}).ok());
}

Eigen::Vector2d tip_of(const Snapshot& s) {
  const double q1 = s[Joint{0}].position(), q12 = q1 + s[Joint{1}].position();
  return {kUpper * std::cos(q1) + kFore * std::cos(q12),
          kUpper * std::sin(q1) + kFore * std::sin(q12)};
}

Command goal_at(double x, double y) { return {.what = SetPoseGoal{{0, 0}, Pose{{x, y, 0}, {}}}}; }

TEST(InverseKinematicsController, ReachesItsGoalWithServosAndWithMotors) {
  for (const char* actuators : {kServos, kMotors}) {
    ControllerOptions options = task_options("ik", {5000, 1});  // for stiff motors
    options.kp = 4000;
    options.kd = 40;
    options.task.posture_cost = 1e-4;
    auto sim = start_task(task_world(planar_arm(actuators, "", "0.0002"), options));
    ASSERT_TRUE(sim->post(goal_at(0.3, 0.5)).ok());
    ASSERT_TRUE(sim->step(20000).ok());
    EXPECT_LT((tip_of(sim->latest()) - Eigen::Vector2d(0.3, 0.5)).norm(), 5e-3) << actuators;
  }
}

TEST(InverseKinematicsController, KeepsItsPoseWithoutAGoal) {
  auto sim = start_task(task_world(planar_arm(kServos), task_options("ik")));
  ASSERT_TRUE(sim->step(500).ok());
  EXPECT_LT((tip_of(sim->latest()) - Eigen::Vector2d(0.9, 0)).norm(), 5e-3);
}

TEST(InverseKinematicsController, HoldsItsVelocityLimit) {
  ControllerOptions options = task_options("ik");
  options.task.velocity_limit = 0.5;
  auto sim = start_task(task_world(planar_arm(kServos), options));
  ASSERT_TRUE(sim->post(goal_at(-0.3, 0.5)).ok());
  double fastest = 0, before[2] = {0, 0};
  for (int step = 0; step < 1000; ++step) {
    ASSERT_TRUE(sim->step(1).ok());
    for (int i = 0; i < 2; ++i) {
      const double target = sim->latest().control(Actuator{i});
      fastest = std::max(fastest, std::abs(target - before[i]) / 0.002);
      before[i] = target;
    }
  }
  EXPECT_NEAR(fastest, 0.5, 1e-9);
}

TEST(InverseKinematicsController, RestsInFrontOfAGoalThatIsOutOfReach) {
  auto sim = start_task(task_world(planar_arm(kServos), task_options("ik")));
  ASSERT_TRUE(sim->post(goal_at(1.2, 1.6)).ok());
  ASSERT_TRUE(sim->step(4000).ok());
  const Eigen::Vector2d tip = tip_of(sim->latest());
  EXPECT_GT(tip.norm(), 0.88);
  EXPECT_GT(tip.dot(Eigen::Vector2d(0.6, 0.8)), 0.8);
  const double before[] = {sim->latest().control(Actuator{0}), sim->latest().control(Actuator{1})};
  ASSERT_TRUE(sim->step(10).ok());
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(sim->latest().control(Actuator{i}), before[i], 2e-5) << "it does not chatter";
}

// The way to the goal leads through a post; targets of the servos are tested, which do not sag.
TEST(InverseKinematicsController, KeepsItsDistanceFromAPost) {
  const std::string post = "<geom name='post' type='sphere' size='.08' pos='.55 .35 0'/>";
  ControllerOptions options = task_options("ik");
  options.task.collision_distance = 0.03;
  const auto world = task_world(planar_arm(kServos, post), options);
  auto sim = start_task(world);
  ASSERT_TRUE(sim->post(goal_at(0.4, 0.6)).ok());
  const mjModel& model = *world->model;
  const DataPtr data = make_data(model);
  double nearest = 1;
  for (int step = 0; step < 2000; ++step) {
    ASSERT_TRUE(sim->step(1).ok());
    for (int i = 0; i < 2; ++i) data->qpos[i] = sim->latest().control(Actuator{i});
    mj_kinematics(&model, data.get());
    for (const char* link : {"upper", "fore"}) {
      const int geom = mj_name2id(&model, mjOBJ_GEOM, link);
      const int other = mj_name2id(&model, mjOBJ_GEOM, "post");
      nearest = std::min(nearest, mj_geomDistance(&model, data.get(), geom, other, 1, nullptr));
    }
  }
  EXPECT_GT(nearest, 0.03 - 5e-4);
  EXPECT_LT(nearest, 0.035) << "the limit was reached";
}

// e(t) of x'' + 2 ζ ω x' + ω² x = 0 from rest.
double step_response(double omega, double zeta, double t) {
  const double damped = omega * std::sqrt(1 - zeta * zeta);
  return std::exp(-zeta * omega * t) *
         (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t));
}

TEST(OperationalSpace, StepResponseIsThatOfADecoupledMass) {
  ControllerOptions options = task_options("osc", {5000, 1});
  options.task.position_stiffness = 64;
  options.task.damping_ratio = 0.5;
  auto sim = start_task(task_world(planar_arm(kMotors, "", "0.0002"), options));
  set_joints(*sim, 0.4, 1.1);
  ASSERT_TRUE(sim->step(1).ok());
  const Eigen::Vector2d begin = tip_of(sim->latest()), step(0.1, -0.15);
  ASSERT_TRUE(sim->post(goal_at(begin.x() + step.x(), begin.y() + step.y())).ok());
  const double start = sim->latest().time();
  for (int sample = 0; sample < 30; ++sample) {
    ASSERT_TRUE(sim->step(200).ok());
    const double left = step_response(8, 0.5, sim->latest().time() - start);
    const Eigen::Vector2d error = begin + step - tip_of(sim->latest());
    EXPECT_LT((error - left * step).norm(), 0.01 * step.norm()) << sample;
  }
}

TEST(OperationalSpace, CompensatesGravityAtRest) {
  auto sim = start_task(task_world(planar_arm(kMotors), task_options("osc")));
  ASSERT_TRUE(sim->step(1000).ok());
  EXPECT_LT((tip_of(sim->latest()) - Eigen::Vector2d(0.9, 0)).norm(), 1e-9);
}

// A third link makes the position redundant: the posture returns without moving the tip.
TEST(OperationalSpace, PostureMovesOnlyTheNullSpace) {
  const std::string xml = R"(<mujoco><option timestep="0.0005" gravity="0 0 0"/><worldbody>
    <body name="upper"><joint name="a" axis="0 0 1"/><geom type="capsule" size=".02" fromto="0 0 0 .4 0 0" mass="1"/>
      <body pos=".4 0 0"><joint name="b" axis="0 0 1"/><geom type="capsule" size=".02" fromto="0 0 0 .3 0 0" mass="1"/>
        <body pos=".3 0 0"><joint name="c" axis="0 0 1"/><geom type="capsule" size=".02" fromto="0 0 0 .2 0 0" mass="1"/>
          <site name="tip" pos=".2 0 0"/></body></body></body></worldbody>
    <actuator><motor joint="a"/><motor joint="b"/><motor joint="c"/></actuator>
    <keyframe><key qpos="0.3 0.8 -0.9"/></keyframe></mujoco>)";
  ControllerOptions options = task_options("osc", {2000, 1});
  options.task.posture_stiffness = 50;
  const auto world = task_world(xml, options);
  world->initial_key = 0;
  auto sim = start_task(world);
  ASSERT_TRUE(sim->step(1).ok());
  const mjModel& model = *world->model;
  const DataPtr data = make_data(model);
  const auto tip = [&] {
    for (int i = 0; i < 3; ++i) data->qpos[i] = sim->latest()[Joint{i}].position();
    mj_kinematics(&model, data.get());
    return Eigen::Vector2d(data->site_xpos[0], data->site_xpos[1]);
  };
  const Eigen::Vector2d begin = tip();
  ASSERT_TRUE(sim->post({.what = SetJointState{Joint{1}, {}, {1.5}}}).ok());  // a push
  ASSERT_TRUE(sim->step(20000).ok());
  EXPECT_LT((tip() - begin).norm(), 1e-4);
  EXPECT_NEAR(sim->latest()[Joint{1}].position(), 0.8, 1e-3);
}

TEST(TaskSpaceControllers, RunTheSameAfterARecompileAndFromACopy) {
  for (const char* type : {"ik", "osc"}) {
    const char* const actuators = type[0] == 'i' ? kServos : kMotors;
    const auto make = [&] { return task_world(planar_arm(actuators), task_options(type)); };
    const auto begin = [&](const std::shared_ptr<CompiledWorld>& world) {
      auto sim = start_task(world);
      EXPECT_TRUE(sim->post(goal_at(0.3, 0.5)).ok());
      EXPECT_TRUE(sim->step(150).ok());
      return sim;
    };
    auto plain = begin(make()), changed = begin(make());
    const auto again = make();
    std::vector<RobotController> controllers;
    controllers.push_back({0, *make_controller(again, again->robots[0]), {500, 1}});
    ASSERT_TRUE(changed->recompile(again, std::move(controllers)).ok());
    ASSERT_TRUE(plain->step(300).ok() && changed->step(300).ok());
    // The chain of hashes contains the recompile; the states are equal to the bit.
    const Snapshot a = plain->latest(), b = changed->latest();
    EXPECT_TRUE(std::ranges::equal(a.state(), b.state())) << type;
  }
}

TEST(TaskSpaceControllers, ErrorsNameTheRemedy) {
  const auto error = [](ControllerOptions options, const std::string& xml) {
    options.loc = {"scene.toml", 7};
    const auto world = task_world(xml, std::move(options));
    const auto made = make_controller(world, world->robots[0]);
    if (made.ok()) return std::string();
    EXPECT_EQ(made.error().loc.line, 7);
    return made.error().to_string();
  };
  ControllerOptions options = task_options("ik");
  options.task.frame = "";
  EXPECT_THAT(error(options, planar_arm(kServos)), HasSubstr("site NAME"));
  options.task.frame = "site tpi";
  EXPECT_THAT(error(options, planar_arm(kServos)), HasSubstr("'tip'"));
  EXPECT_THAT(error(task_options("ik"), planar_arm("")), HasSubstr("no motor"));
  EXPECT_THAT(
      error(task_options("ik"), planar_arm(std::string(kServos) + "<motor joint='elbow'/>")),
      Not(""));
  EXPECT_THAT(error(task_options("osc"), planar_arm(kServos)), HasSubstr("servo"));
  EXPECT_THAT(error(task_options("osc"), planar_arm("<motor joint='shoulder'/>")),
              HasSubstr("'elbow' has no motor"));
}

}  // namespace
}  // namespace gloam

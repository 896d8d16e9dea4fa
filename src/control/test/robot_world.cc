#include "robot_world.h"

#include <gtest/gtest.h>

#include "control/controllers.h"
#include "scene/files/mujoco_guard.h"

namespace gloam {

std::shared_ptr<CompiledWorld> make_robot_world(const char* mjcf, const RobotOptions& options) {
  install_mujoco_handler();
  char error[500] = "";
  auto world = std::make_shared<CompiledWorld>();
  const SpecPtr spec(mj_parseXMLString(mjcf, nullptr, error, sizeof(error)));
  EXPECT_TRUE(spec) << error;
  world->model.reset(mj_compile(spec.get(), nullptr));
  EXPECT_TRUE(world->model) << mjs_getError(spec.get());
  RobotInstance robot;
  robot.name = "robot";
  robot.root_body = 1;
  robot.options = options;
  world->robots.push_back(robot);
  return world;
}

std::unique_ptr<Simulator> start_robot(const std::shared_ptr<const CompiledWorld>& world) {
  const ControllerOptions& options = world->robots[0].options.controller;
  auto controller = make_robot_controller(world, 0, options);
  EXPECT_TRUE(controller.ok()) << (controller.ok() ? "" : controller.error().message);
  auto sim = Simulator::create(world, {.pace = Pace::kLockstep});
  EXPECT_TRUE(sim.ok());
  EXPECT_TRUE((*sim)->add_controller(0, std::move(*controller), options.rate).ok());
  (*sim)->start();
  return std::move(*sim);
}

BodyState base_of(Simulator& sim) {
  Instant instant;
  EXPECT_TRUE(instant.solve(sim.latest()).ok());
  return *instant.body(Body{1});
}

double force_of(Simulator& sim, int actuator) {
  Instant instant;
  EXPECT_TRUE(instant.solve(sim.latest()).ok());
  return *instant.force(Actuator{actuator});
}

}  // namespace gloam

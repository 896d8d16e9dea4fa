#include "robot_world.h"

#include <gtest/gtest.h>

#include "control/controllers.h"
#include "scene/files/mujoco_guard.h"
#include "trot_robots.h"

namespace gloam {

std::shared_ptr<CompiledWorld> make_robot_world(const std::string& mjcf, RobotOptions options) {
  install_mujoco_handler();
  auto world = std::make_shared<CompiledWorld>();
  world->model = compile_text(mjcf);
  EXPECT_TRUE(world->model);
  if (options.name.empty()) options.name = "robot";
  RobotInstance robot;
  robot.name = options.name;
  robot.root_body = 1;
  robot.options = std::move(options);
  world->robots.push_back(std::move(robot));
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

#include "actuator_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "robot_world.h"
#include "trot_robots.h"

namespace gloam {

std::shared_ptr<CompiledWorld> wheel_world(const Wheel& wheel, const RobotOptions& options) {
  RobotOptions named = options;
  named.name = "rig";
  auto world = make_robot_world(
      fmt::format(
          R"(<mujoco><option timestep="{}" gravity="0 0 0"/><worldbody><body name="wheel">
           <joint name="wheel" axis="0 0 1" armature="{}"/>
           <inertial pos="0 0 0" mass="1" diaginertia="{} {} {}"/></body></worldbody>
         <actuator>{}</actuator>
         <keyframe><key qpos="0" qvel="{}"/></keyframe></mujoco>)",
          wheel.timestep, wheel.armature, wheel.inertia, wheel.inertia, wheel.inertia,
          wheel.actuator, wheel.speed),
      std::move(named));
  world->initial_key = 0;
  return world;
}

std::vector<RobotController> robots_of(const std::shared_ptr<const CompiledWorld>& world,
                                       const ActuatorNetworkLoader& network) {
  std::vector<RobotController> robots;
  auto actuators = make_actuators(*world, world->robots[0], network);
  EXPECT_TRUE(actuators.ok()) << actuators.error().to_string();
  robots.push_back({0, nullptr, {1, 1}, std::move(*actuators)});
  return robots;
}

ActuatorRig::ActuatorRig(const Wheel& wheel, const RobotOptions& options,
                         const ActuatorNetworkLoader& network)
    : world_(wheel_world(wheel, options)) {
  const ActuatorMaker make = [network](const CompiledWorld& compiled, const RobotInstance& robot) {
    return make_actuators(compiled, robot, network);
  };
  auto sim = Simulator::create(world_, {.pace = Pace::kLockstep, .makers = {{}, make}});
  EXPECT_TRUE(sim.ok());
  sim_ = std::move(*sim);
  const Status added = sim_->add_robot(std::move(robots_of(world_, network)[0]));
  EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().to_string());
  sim_->start();
}

void ActuatorRig::command(double control) {
  EXPECT_TRUE(sim_->post({.what = SetControl{Actuator{0}, control}}).ok());
}

void ActuatorRig::load(double torque) {
  EXPECT_TRUE(sim_->post({.what = SetWrench{Body{1}, {}, {0, 0, torque}}}).ok());
}

void ActuatorRig::step(int64_t n) {
  const Status stepped = sim_->step(n);
  EXPECT_TRUE(stepped.ok()) << (stepped.ok() ? "" : stepped.error().to_string());
}

double ActuatorRig::force() const {
  Instant instant;
  EXPECT_TRUE(instant.solve(sim_->latest()).ok());
  return instant.force(Actuator{0}).value();
}

}  // namespace gloam

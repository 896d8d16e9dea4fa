#pragma once
// Small arms for tests of joint controllers and trajectories.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "control/controllers.h"
#include "robot_world.h"
#include "sim/loop/simulator.h"

namespace gloam {

/// One hinge about y of inertia 0.1 kg m² without gravity, driven by a motor with gear 2.
inline constexpr const char* kWheel = R"(<mujoco><option timestep="0.0005" gravity="0 0 0"/>
  <worldbody><body name="a"><joint name="j" axis="0 1 0"/>
  <inertial pos="0 0 0" mass="1" diaginertia=".1 .1 .1"/></body></worldbody>
  <actuator><motor name="j" joint="j" gear="2"/></actuator></mujoco>)";

/// Three equal pendulums of 2 kg at 0.5 m, horizontal at 0: on a motor, a servo of position and one
/// of velocity.
inline constexpr const char* kPendulums =
    R"(<mujoco><compiler angle="radian"/><option timestep="0.001"/><worldbody>
  <body name="post"><geom size=".01"/>
    <body name="a"><joint name="m" axis="0 1 0" range="-6 6" limited="true"/>
      <inertial pos=".5 0 0" mass="2" diaginertia=".01 .01 .01"/></body>
    <body name="b" pos="0 2 0"><joint name="p" axis="0 1 0"/>
      <inertial pos=".5 0 0" mass="2" diaginertia=".01 .01 .01"/></body>
    <body name="c" pos="0 4 0"><joint name="v" axis="0 1 0"/>
      <inertial pos=".5 0 0" mass="2" diaginertia=".01 .01 .01"/></body>
  </body></worldbody>
  <actuator><motor name="m" joint="m" gear="2"/><position name="p" joint="p" kp="80" kv="3"/>
    <velocity name="v" joint="v" kv="20"/></actuator></mujoco>)";

inline std::shared_ptr<CompiledWorld> arm_world(const char* xml, ControllerOptions options) {
  return make_robot_world(xml, {.name = "arm", .controller = std::move(options)});
}

/// A paused simulation with the controllers of its scene.
inline std::unique_ptr<Simulator> run_arm(const std::shared_ptr<CompiledWorld>& world) {
  auto sim = Simulator::create(world, {.pace = Pace::kLockstep, .makers = robot_makers()});
  EXPECT_TRUE(sim.ok());
  auto controllers = make_controllers(world, robot_makers());
  EXPECT_TRUE(controllers.ok()) << controllers.error().to_string();
  for (RobotController& c : *controllers)
    EXPECT_TRUE((*sim)->add_controller(c.robot, std::move(c.controller), c.rate).ok());
  (*sim)->start();
  return std::move(*sim);
}

inline constexpr Robot kArmRobot{0, 0};

}  // namespace gloam

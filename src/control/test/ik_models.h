#pragma once
// Models of which the tests of inverse kinematics and of operational-space control know closed
// forms.

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// Lengths of the planar arm's links [m].
inline constexpr double kUpper = 0.5, kFore = 0.4;

/// A planar arm of two hinges about z in the plane z = 0, with a site "tip" at its end; `inside` is
/// added to the world body, `actuators` are its own. Gravity along -y.
inline std::string planar_arm(const std::string& actuators, const std::string& inside = "",
                              const std::string& timestep = "0.002") {
  return "<mujoco><compiler angle='radian' autolimits='true'/><option timestep='" + timestep +
         "' gravity='0 -9.81 0' integrator='implicitfast'/><worldbody>" + inside + R"(
    <body name="upper"><joint name="shoulder" axis="0 0 1" range="-2.5 2.5"/>
      <geom name="upper" type="capsule" size=".02" fromto="0 0 0 .5 0 0" mass="1"/>
      <body name="fore" pos=".5 0 0"><joint name="elbow" axis="0 0 1" range="-2.5 2.5"/>
        <geom name="fore" type="capsule" size=".02" fromto="0 0 0 .4 0 0" mass=".7"/>
        <site name="tip" pos=".4 0 0"/></body></body></worldbody>
    <actuator>)" +
         actuators + "</actuator></mujoco>";
}

inline const char* const kMotors =
    "<motor name='s' joint='shoulder' gear='2'/><motor name='e' joint='elbow'/>";
inline const char* const kServos =
    "<position name='s' joint='shoulder' kp='4000' kv='200'/>"
    "<position name='e' joint='elbow' kp='2000' kv='100'/>";

inline ModelPtr compile_model(const std::string& xml) {
  char error[500] = "";
  const SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error)));
  EXPECT_TRUE(spec) << error;
  ModelPtr model(mj_compile(spec.get(), nullptr));
  EXPECT_TRUE(model);
  return model;
}

inline std::vector<int> all_dofs(const mjModel& model) {
  std::vector<int> dofs(static_cast<size_t>(model.nv));
  std::iota(dofs.begin(), dofs.end(), 0);
  return dofs;
}

}  // namespace gloam

// A real simulation of a small model, for tests of the parts behind the page.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "gloam/simulation.h"

namespace gloam::studio {

/// A slide with a motor, a free box, a mocap body, a constraint and a keyframe.
inline constexpr const char* kRigModel = R"(<mujoco><option timestep="0.002" gravity="0 0 0"/>
  <worldbody><light pos="0 0 3"/><geom name="floor" type="plane" size="3 3 0.1"/>
    <camera name="side" pos="0 -3 1" xyaxes="1 0 0 0 0.3 1"/>
    <body name="cart" pos="-1 0 1"><joint name="x" type="slide" axis="1 0 0"/>
      <geom name="cart" size="0.2" mass="1"/></body>
    <body name="box" pos="0 0 1"><freejoint name="free"/>
      <geom name="box" type="box" size="0.3 0.3 0.3" mass="2"/></body>
    <body name="hand" mocap="true" pos="1 0 1">
      <geom name="hand" size="0.2" contype="0" conaffinity="0"/></body>
  </worldbody>
  <equality><weld name="held" body1="box" active="false"/></equality>
  <actuator><motor name="push" joint="x" ctrlrange="-5 5"/></actuator>
  <sensor><jointpos name="place" joint="x"/></sensor>
  <keyframe><key name="away" qpos="0.5 0 1 2 1 0 0 0" ctrl="1.5"/></keyframe>
</mujoco>)";

inline std::unique_ptr<Simulation> make_rig(const SimulationOptions& options = {}) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) /
                                     ("gloam_rig_" + std::to_string(::getpid()) + ".xml");
  std::ofstream(file) << kRigModel;
  const Result<Scene> scene = load_scene(file);
  EXPECT_TRUE(scene.ok()) << scene.error().to_string();
  const Result<World> world = World::compile(*scene);
  EXPECT_TRUE(world.ok()) << world.error().to_string();
  std::filesystem::remove(file);
  auto simulation = Simulation::create(*world, options);
  EXPECT_TRUE(simulation.ok());
  return std::move(*simulation);
}

}  // namespace gloam::studio

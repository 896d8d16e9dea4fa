#pragma once
// A small scene for the tests of bridges: a room with a crate, a table, a mocap hand and a door, an
// arm and a chair; and an Operator on it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "bridge/operations/operator.h"

namespace gloam::bridge {

inline constexpr const char* kRoom = R"(
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 0.1"/>
    <body name="crate" pos="1 2 0.5"><freejoint/><geom type="box" size="0.1 0.2 0.5" mass="3"/></body>
    <body name="table" pos="0 -1 0.4"><geom type="box" size="0.5 0.3 0.4"/></body>
    <body name="hand" mocap="true" pos="2 0 1"><geom type="sphere" size="0.05"/></body>
    <body name="door" pos="3 0 1"><joint type="hinge" axis="0 0 1"/><geom type="box" size="0.4 0.02 1"/></body>
  </worldbody>
</mujoco>)";
inline constexpr const char* kArm = R"(
<mujoco model="arm">
  <worldbody><body name="base"><geom size="0.05" mass="1"/>
    <body name="link"><joint name="elbow" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02"/></body>
  </body></worldbody>
  <actuator><motor name="elbow" joint="elbow"/></actuator>
</mujoco>)";
inline constexpr const char* kBall = R"(
<mujoco model="ball">
  <worldbody><body name="ball"><freejoint/><geom size="0.1" mass="1"/></body></worldbody>
</mujoco>)";
inline constexpr const char* kUrdf = R"(<?xml version="1.0"?>
<!-- a comment with <sdf> in it -->
<robot name="box"><link name="base"><inertial><mass value="1"/>
  <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link></robot>)";
inline constexpr const char* kScene = R"(
[scene]
name = "lab"
[environment]
file = "room.xml"
[[robot]]
name = "arm"
file = "arm.xml"
position = [0, 3, 1]
[robot.controller]
type = "joint_position"
kp = 50
kd = 5
[[prop]]
name = "seat"
kind = "chair"
position = [-2, 0, 0]
loose = false
[[goal]]
robot = "arm"
position = [1, 1, 0]
radius = 0.3
)";

/// A scene in a folder of its own, whose ways up end in the test's own folder.
class Lab : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "gloam_operator_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    top_ = name;
    folder_ = top_ / "a" / "b" / "c" / "d";
    std::filesystem::create_directories(folder_);
    write("room.xml", kRoom);
    write("arm.xml", kArm);
    write("ball.xml", kBall);
    write("lab.toml", kScene);
    write("other.toml",
          "# Another one.\n[environment]\nfile = \"room.xml\"\n[[robot]]\nname = \"ball\"\n"
          "file = \"ball.xml\"\n");
    std::ofstream(top_ / "secret.xml") << kBall;
    const Result<Scene> scene = load_scene(folder_ / "lab.toml");
    ASSERT_TRUE(scene.ok()) << scene.error().to_string();
    const Result<World> world = World::compile(*scene);
    ASSERT_TRUE(world.ok()) << world.error().to_string();
    auto simulation = Simulation::create(*world, {});
    ASSERT_TRUE(simulation.ok()) << simulation.error().to_string();
    simulation_ = std::move(*simulation);
    op_ = std::make_unique<Operator>(*simulation_);
    op_->set_recording_folder(folder_ / "logs");
  }
  void TearDown() override {
    op_.reset();
    simulation_.reset();
    std::error_code code;
    std::filesystem::remove_all(top_, code);
  }
  void write(const char* name, const char* text) const { std::ofstream(folder_ / name) << text; }
  Operator& op() { return *op_; }
  Entity entity(const char* name) {
    Result<Entity> found = op().find_entity(name);
    EXPECT_TRUE(found.ok()) << found.error().to_string();
    return found.ok() ? *found : Entity{};
  }
  SpawnResult spawn_ball(const std::string& name, bool rename = false) {
    return op().spawn(
        {.name = name, .allow_renaming = rename, .text = kBall, .X_FE = {{0, 0, 2}, {}}});
  }

  std::filesystem::path top_, folder_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Operator> op_;
};

}  // namespace gloam::bridge

// The URDF that is made of a robot's model, loaded again: the same tree, poses, masses and limits.

#include <gmock/gmock.h>

#include <cmath>

#include "ros/codec.h"
#include "ros/messages/std_msgs.h"
#include "runtime/test/robots.h"
#include "runtime/test/scenes.h"
#include "topics/model_frames.h"
#include "topics/robot_urdf.h"
#include "topics/topic_table.h"
#include "world/model_names.h"

namespace gloam {
namespace {

using testing::HasSubstr;
using testing::Not;

// Joints away from their bodies' origins, several at one body, references, slides, all shapes.
constexpr const char* kOddArm = R"(<mujoco model="arm"><compiler angle="radian"/>
<asset><mesh name="wedge" vertex="0 0 0  .2 0 0  0 .1 0  0 0 .3"/></asset>
<worldbody><body name="base" pos=".1 .2 .3" euler=".1 .2 .3"><freejoint/>
  <geom type="box" size=".2 .1 .05" mass="3" pos=".01 .02 .03" euler=".3 0 .1"/>
  <body name="hip" pos="0 .1 0" quat=".7 .7 0 .1">
    <joint name="yaw" axis="0 0 1" pos=".02 .01 0" range="-1 1.5"/>
    <joint name="roll" axis="1 .2 0" ref=".3" pos="0 0 .03" damping=".2"/>
    <geom type="capsule" size=".03" fromto="0 0 0 .1 .05 .2" mass=".4"/>
    <body name="shin &amp; foot" pos=".1 0 .2" euler="1.5707963267948966 1.5707963267948966 0">
      <joint name="extend" type="slide" axis="0 1 1" ref=".05" pos=".3 .3 .3"/>
      <joint name="ankle" axis="0 1 0" frictionloss=".1" actuatorfrcrange="-7 5"/>
      <geom type="mesh" mesh="wedge" mass=".2"/><geom type="ellipsoid" size=".1 .2 .3" mass=".1"/>
      <body name="toe" pos="0 0 -.1"><geom type="sphere" size=".02" mass=".05" contype="0"
        conaffinity="0" rgba="1 0 0 1"/></body></body></body>
  <body name="wheel"><joint axis="0 1 0" pos="0 .3 0"/>
    <geom type="cylinder" size=".1 .02" mass=".3"/></body></body></worldbody>
<actuator><motor joint="ankle"/></actuator></mujoco>)";

constexpr const char* kPendulum = R"(<mujoco model="pendulum"><worldbody>
<body name="pole" pos="0 0 1"><joint name="swing" axis="0 1 0"/>
  <geom type="capsule" size=".02" fromto="0 0 0 0 0 .5" mass="1"/></body></worldbody>
<actuator><motor joint="swing"/></actuator></mujoco>)";

/// A URDF no bodies of which MuJoCo fuses.
std::string unfused(std::string urdf) {
  urdf.insert(urdf.find('>', urdf.find("<robot")) + 1,
              "<mujoco><compiler fusestatic=\"false\" discardvisual=\"false\"/></mujoco>");
  return urdf;
}

class RobotUrdf : public testing::Test {
 protected:
  World world_of(const std::string& file) {
    const std::string scene = "[[robot]]\nname = \"r\"\nfile = \"" + file + "\"\n";
    const auto parsed = parse_scene(scene, folder_.path());
    EXPECT_TRUE(parsed.ok()) << parsed.error().to_string();
    Result<World> world = World::compile(*parsed);
    EXPECT_TRUE(world.ok()) << world.error().to_string();
    return *world;
  }
  static std::string urdf_of(const World& world) {
    return robot_urdf(*world.compiled()->model, world.compiled()->robots[0]);
  }
  /// The World of the URDF alone, no bodies of which are fused.
  World again(const std::string& urdf) {
    folder_.write("copy.urdf", unfused(urdf));
    return world_of("copy.urdf");
  }

  TempFolder folder_;
};

int joint_named(const mjModel& m, const std::string& name) {
  return mj_name2id(&m, mjOBJ_JOINT, name.c_str());
}

/// Poses of all bodies of the robot relative to its root are those of its URDF, and what moves it.
/// Names of the URDF's World begin with `prefix`.
void expect_same_tree(const World& robot, const World& urdf, int root_body,
                      const std::string& prefix) {
  const mjModel &a = *robot.compiled()->model, &b = *urdf.compiled()->model;
  const RobotInstance& instance = robot.compiled()->robots[0];
  const DataPtr at(mj_makeData(&a)), bt(mj_makeData(&b));
  const auto in_root = [](const mjModel& m, const mjData& d, int root, int body) {
    const auto pose = [&d](int i) {
      const mjtNum *p = d.xpos + 3 * i, *q = d.xquat + 4 * i;
      return Pose{{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
    };
    EXPECT_LT(body, static_cast<int>(m.nbody));
    return product(inverse(pose(root)), pose(body));
  };
  const int b_root =
      root_body == 0 ? 0 : mj_name2id(&b, mjOBJ_BODY, (prefix + body_frame(a, root_body)).c_str());
  ASSERT_GE(b_root, 0);
  int bodies = 0;
  for (int round = 0; round < 20; ++round) {
    for (int joint = 0; joint < static_cast<int>(a.njnt); ++joint) {
      if (a.jnt_type[joint] != mjJNT_HINGE && a.jnt_type[joint] != mjJNT_SLIDE) continue;
      const std::string name = prefix + joint_label(a, joint, instance.prefix);
      const int other = joint_named(b, name);
      ASSERT_GE(other, 0) << name;
      const double value = std::sin(1.7 * joint + 2.3 * round) * (round == 0 ? 0 : 1.5);
      at->qpos[a.jnt_qposadr[joint]] = bt->qpos[b.jnt_qposadr[other]] = value;
      EXPECT_EQ(a.jnt_type[joint], b.jnt_type[other]);
      if (a.jnt_limited[joint]) {
        EXPECT_NEAR(a.jnt_range[2 * joint], b.jnt_range[2 * other], 1e-12);
        EXPECT_NEAR(a.jnt_range[2 * joint + 1], b.jnt_range[2 * other + 1], 1e-12);
      }
      EXPECT_NEAR(a.dof_damping[a.jnt_dofadr[joint]], b.dof_damping[b.jnt_dofadr[other]], 1e-12);
    }
    mj_kinematics(&a, at.get());
    mj_kinematics(&b, bt.get());
    for (int body = instance.root_body; body < static_cast<int>(a.nbody); ++body) {
      const std::string name = prefix + body_frame(a, body);
      const int other = mj_name2id(&b, mjOBJ_BODY, name.c_str());
      ASSERT_GE(other, 0) << name;
      const Pose X = in_root(a, *at, root_body, body), Y = in_root(b, *bt, b_root, other);
      EXPECT_NEAR(X.p.x, Y.p.x, 1e-9) << name;
      EXPECT_NEAR(X.p.y, Y.p.y, 1e-9) << name;
      EXPECT_NEAR(X.p.z, Y.p.z, 1e-9) << name;
      const Pose D = product(inverse(X), Y);
      EXPECT_LT(std::abs(D.q.x) + std::abs(D.q.y) + std::abs(D.q.z), 1e-9) << name;
      EXPECT_NEAR(a.body_mass[body], b.body_mass[other], 1e-12 + 1e-9 * a.body_mass[body]);
      const double spin =
          a.body_inertia[3 * body] + a.body_inertia[3 * body + 1] + a.body_inertia[3 * body + 2];
      const double spin_there =
          b.body_inertia[3 * other] + b.body_inertia[3 * other + 1] + b.body_inertia[3 * other + 2];
      EXPECT_NEAR(spin, spin_there, 1e-9 * spin) << name;
      ++bodies;
    }
  }
  EXPECT_GT(bodies, 0);
}

TEST_F(RobotUrdf, OfAnOddRobotIsTheSameTree) {
  folder_.write("arm.xml", kOddArm);
  const World world = world_of("arm.xml");
  const std::string urdf = urdf_of(world);
  expect_same_tree(world, again(urdf), world.compiled()->robots[0].root_body, "r/");
  EXPECT_THAT(urdf, HasSubstr("<link name=\"r/shin &amp; foot\">"));
  EXPECT_THAT(urdf, HasSubstr("effort=\"7\""));
  EXPECT_THAT(urdf, HasSubstr("friction=\"0.1\""));
  EXPECT_THAT(urdf, HasSubstr("type=\"continuous\""));  // without a range
  EXPECT_THAT(urdf, HasSubstr("lower=\"-1\" upper=\"1.5\""));
  EXPECT_THAT(urdf, HasSubstr("<color rgba=\"1 0 0 1\"/>"));
}

TEST_F(RobotUrdf, ThatHangsOnTheWorldBeginsThere) {
  folder_.write("pendulum.xml", kPendulum);
  const World world = world_of("pendulum.xml");
  const std::string urdf = urdf_of(world);
  EXPECT_THAT(urdf, HasSubstr("<link name=\"world\"/>"));
  expect_same_tree(world, again(urdf), 0, "r/");
}

TEST_F(RobotUrdf, IsWhatTheTopicTellsUnlessTheFileIsOne) {
  folder_.write("pendulum.xml", kPendulum);
  const auto told = [](const World& world) {
    const TopicTable table = *make_topic_table(world.compiled());
    const Topic& topic = *find_topics(table, "/r/robot_description")->front();
    MessageBytes bytes;
    EXPECT_TRUE(std::get<LatchedEncoder>(topic.code)(topic.info, {}, &bytes).ok());
    return decode<std_msgs::String>(bytes)->data;
  };
  const World world = world_of("pendulum.xml");
  EXPECT_EQ(told(world), urdf_of(world));
  EXPECT_THAT(told(world), Not(HasSubstr("<mujoco")));
  const std::string file = R"(<?xml version="1.0"?>
<robot name="p"><link name="base"/><link name="tip"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="continuous"><parent link="base"/><child link="tip"/></joint></robot>)";
  folder_.write("own.urdf", file);
  EXPECT_EQ(told(world_of("own.urdf")), file);
}

class ThirdPartyUrdf : public ThirdPartyRobot {};

TEST_P(ThirdPartyUrdf, IsTheSameTree) {
  const World world = compile_file(file_);
  const RobotInstance& robot = world.compiled()->robots.at(0);
  ASSERT_GT(robot.root_body, 0);
  folder_.write("copy.urdf", unfused(robot_urdf(*world.compiled()->model, robot)));
  const World copy = compile_file(folder_.path() / "copy.urdf");
  const bool hangs = world.compiled()->model->body_jntnum[robot.root_body] > 0 &&
                     world.compiled()->model->body_dofnum[robot.root_body] < 6;
  expect_same_tree(world, copy, hangs ? 0 : robot.root_body, "");
}

INSTANTIATE_TEST_SUITE_P(Robots, ThirdPartyUrdf, testing::Values(kGo1, kG1, kYam, kPanda));

}  // namespace
}  // namespace gloam

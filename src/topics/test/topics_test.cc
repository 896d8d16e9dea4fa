// The table of topics of a scene, its messages at known instants, streams of them, and inputs as
// Commands.

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <map>

#include "gloam/simulation.h"
#include "ros/messages/nav_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/tf2_msgs.h"
#include "ros/messages/trajectory_msgs.h"
#include "scene/test/temp_folder.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/test/topic_inbox.h"
#include "topics/topic_table.h"

namespace gloam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kCart = R"(<mujoco model="cart"><option timestep="0.002"/>
<worldbody><geom name="ground" type="plane" size="5 5 .1"/><light pos="0 0 3"/>
<body name="base" pos="0 0 0.1"><freejoint/>
  <geom type="box" size=".2 .1 .1" mass="1"/><site name="imu" pos="0 0 .1"/>
  <camera name="eye" pos=".25 0 0" xyaxes="0 -1 0 0 0 1"/>
  <body name="arm" pos="0 0 .2"><joint name="lift" axis="0 1 0" range="-57.3 57.3"/>
    <geom type="capsule" size=".02" fromto="0 0 0 .2 0 0" mass=".01"/>
    <body name="tip" pos=".2 0 0" quat="0 1 0 0"><geom size=".02" mass=".01"/></body></body></body>
</worldbody>
<actuator><position name="lift" joint="lift" kp="5"/></actuator>
<sensor><gyro name="gyro" site="imu"/><accelerometer name="accel" site="imu"/>
  <rangefinder name="range" site="imu" cutoff="10"/><jointpos name="angle" joint="lift"/></sensor>
</mujoco>)";

constexpr const char* kTopicScene = R"(
[[robot]]
name = "cart"
file = "cart.xml"
[robot.controller]
type = "joint_position"
[[lidar]]
name = "roof"
preset = "VLP-16"
body = "cart/base"
position = [0, 0, 0.3]
)";

class Topics : public testing::Test {
 protected:
  Topics() { folder_.write("cart.xml", kCart); }

  World world_of(const std::string& more = "") {
    return *World::compile(*parse_scene(kTopicScene + more, folder_.path()));
  }
  std::vector<std::string> names(const World& world) {
    std::vector<std::string> names;
    const std::vector<TopicInfo> topics = *list_topics(world);
    for (const TopicInfo& topic : topics) names.push_back(topic.name);
    return names;
  }
  /// One message of a topic of an instant.
  template <class T>
  T message(const char* name, TopicInstant& instant) {
    const Topic& topic = *find_topics(table_, name)->front();
    MessageBytes bytes;
    EXPECT_TRUE(std::get<InstantEncoder>(topic.code)(topic.info, instant, &bytes).ok());
    return *decode<T>(bytes);
  }

  TempFolder folder_;
  TopicTable table_;
};

TEST_F(Topics, AStreamGainsAndLosesTopicsOfAllKinds) {
  auto simulation = *Simulation::create(world_of(), {.pace = Pace::kLockstep});
  TopicInbox inbox;
  const std::vector<std::string> few = {"/cart/joint_states", "/cart/odom", "/cart/imu/imu"};
  std::vector<std::string> more = few;
  for (const char* name : {"/tf", "/cart/range", "/roof/points", "/tf_static"})
    more.push_back(name);
  auto stream = *simulation->open_topics({.topics = few, .required = true}, inbox.callback());
  const auto counts = [&](const std::vector<std::string>& topics) {
    stream->flush();
    std::vector<size_t> counts;
    for (const std::string& topic : topics) counts.push_back(inbox.messages[topic].size());
    return counts;
  };
  ASSERT_TRUE(simulation->step(101).ok());
  EXPECT_THAT(counts(few), testing::Each(testing::Gt(5u)));
  ASSERT_TRUE(stream->set_topics(more).ok());
  ASSERT_TRUE(simulation->step(200).ok());
  EXPECT_THAT(counts(more), testing::Each(testing::Gt(0u)));
  EXPECT_EQ(inbox.messages["/tf_static"].size(), 1u);
  const std::vector<size_t> before = counts(more);
  ASSERT_TRUE(stream->set_topics(std::vector<std::string>{"/cart/odom"}).ok());
  ASSERT_TRUE(simulation->step(100).ok());
  const std::vector<size_t> after = counts(more);
  for (size_t i = 0; i < more.size(); ++i)
    EXPECT_EQ(after[i] > before[i], more[i] == "/cart/odom") << more[i];
  const std::vector<int64_t>& steps = inbox.steps["/cart/odom"];
  EXPECT_TRUE(std::ranges::adjacent_find(steps, std::greater_equal<>()) == steps.end());
  EXPECT_FALSE(stream->set_topics(std::vector<std::string>{"/nowhere"}).ok());
  EXPECT_TRUE(stream->status().ok());
}

TEST_F(Topics, FollowTheConventionsOfRos) {
  const World world = world_of();
  const std::vector<TopicInfo> topics = *list_topics(world);
  const auto expect = [&](const char* name, const char* type, const char* frame) {
    const auto found = std::ranges::find(topics, name, &TopicInfo::name);
    ASSERT_NE(found, topics.end()) << name;
    EXPECT_EQ(found->type, type) << name;
    EXPECT_EQ(found->frame_id, frame) << name;
    EXPECT_TRUE(message_info(found->type).ok()) << name;
  };
  expect("/clock", "rosgraph_msgs/msg/Clock", "");
  expect("/tf", "tf2_msgs/msg/TFMessage", "world");
  expect("/tf_static", "tf2_msgs/msg/TFMessage", "world");
  expect("/contacts", "gloam_msgs/msg/Contacts", "world");
  expect("/cart/joint_states", "sensor_msgs/msg/JointState", "cart/base");
  expect("/cart/odom", "nav_msgs/msg/Odometry", "world");
  expect("/cart/imu/imu", "sensor_msgs/msg/Imu", "cart/imu");
  expect("/cart/range", "sensor_msgs/msg/Range", "cart/imu");
  expect("/cart/angle", "std_msgs/msg/Float64MultiArray", "cart/arm");
  expect("/cart/eye/image_raw", "sensor_msgs/msg/Image", "cart/eye_optical_frame");
  expect("/cart/eye/image_raw/compressed", "sensor_msgs/msg/CompressedImage",
         "cart/eye_optical_frame");
  expect("/cart/eye/camera_info", "sensor_msgs/msg/CameraInfo", "cart/eye_optical_frame");
  expect("/roof/points", "sensor_msgs/msg/PointCloud2", "roof");
  expect("/cart/cmd_vel", "geometry_msgs/msg/Twist", "");
  expect("/cart/joint_trajectory", "trajectory_msgs/msg/JointTrajectory", "");
  EXPECT_THAT(names(world), Not(Contains("/cart/gyro")));  // a part of the IMU
  EXPECT_THAT(names(world), Not(Contains("/cart/eye/thermal/image_raw")));
}

TEST_F(Topics, AreChangedByTheScene) {
  const World world = world_of(R"(
[[topic]]
name = "/roof/points"
rename = "/velodyne_points"
frame = "velodyne"
rate = 5
[[topic]]
name = "/cart/eye/*"
off = true
)");
  const auto topics = *list_topics(world);
  const auto points = std::ranges::find(topics, "/velodyne_points", &TopicInfo::name);
  ASSERT_NE(points, topics.end());
  EXPECT_EQ(points->frame_id, "velodyne");
  EXPECT_EQ(points->rate, (Rational{5, 1}));
  EXPECT_THAT(names(world), Not(Contains(HasSubstr("/cart/eye"))));
  const auto wrong = list_topics(world_of("[[topic]]\nname = \"/roof/pionts\"\n"));
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().to_string(), HasSubstr("/roof/points"));
  EXPECT_GT(wrong.error().loc.line, 0);
  EXPECT_FALSE(
      list_topics(world_of("[[topic]]\nname = \"/roof/points\"\nrename = \"/tf\"\n")).ok());
}

TEST_F(Topics, NamesOfElementsBecomeNamesThatRosTakes) {
  EXPECT_EQ(topic_token("go1/front left"), "go1/front_left");
  EXPECT_EQ(topic_token("3d/4"), "_3d/_4");
  EXPECT_EQ(topic_token("//a//b/"), "a/b");
  EXPECT_EQ(topic_token(""), "_");
  EXPECT_EQ(topic_token("t\xc3\xbcr"), "t_r");
}

TEST_F(Topics, TimesAreTheNearestNanosecond) {
  EXPECT_EQ(ros_time(1.25), (builtin_interfaces::Time{1, 250000000}));
  EXPECT_EQ(ros_time(0.1 + 0.2), (builtin_interfaces::Time{0, 300000000}));
  EXPECT_EQ(ros_time(0.9999999999), (builtin_interfaces::Time{1, 0}));
  EXPECT_EQ(ros_time(-1), (builtin_interfaces::Time{0, 0}));
}

// The frames of a message form the tree of bodies, and lead to the poses that physics has.
TEST_F(Topics, FramesLeadToThePosesOfBodies) {
  const World world = world_of();
  table_ = *make_topic_table(world.compiled());
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  ASSERT_TRUE(simulation->step(100).ok());
  const Snapshot now = simulation->latest();
  auto solver = *PoseSolver::create(world.compiled());
  TopicInstant instant(now, *solver);
  const auto dynamic = message<tf2_msgs::TFMessage>("/tf", instant);
  const Topic& fixed = *find_topics(table_, "/tf_static")->front();
  MessageBytes bytes;
  ASSERT_TRUE(std::get<LatchedEncoder>(fixed.code)(fixed.info, {}, &bytes).ok());
  const auto still = *decode<tf2_msgs::TFMessage>(bytes);
  ASSERT_EQ(dynamic.transforms.size(), 2u);  // the base and its arm
  std::map<std::string, std::pair<std::string, Pose>> frames;
  for (const auto* list : {&dynamic, &still}) {
    for (const auto& t : list->transforms) {
      const auto& p = t.transform.translation;
      const auto& q = t.transform.rotation;
      EXPECT_TRUE(
          frames
              .emplace(t.child_frame_id,
                       std::pair(t.header.frame_id, Pose{{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}}))
              .second)
          << t.child_frame_id;
    }
  }
  const auto pose_in_world = [&](std::string frame) {
    Pose X = {};
    for (; frame != "world" && frames.contains(frame); frame = frames[frame].first)
      X = product(frames[frame].second, X);
    EXPECT_EQ(frame, "world");
    return X;
  };
  for (const char* body : {"cart/base", "cart/arm", "cart/tip"}) {
    const Pose X = pose_in_world(body), truth = *simulation->body_pose(*world.find_body(body));
    EXPECT_NEAR(X.p.x, truth.p.x, 1e-6) << body;
    EXPECT_NEAR(X.p.y, truth.p.y, 1e-6) << body;
    EXPECT_NEAR(X.p.z, truth.p.z, 1e-6) << body;
    const double cosine =
        X.q.w * truth.q.w + X.q.x * truth.q.x + X.q.y * truth.q.y + X.q.z * truth.q.z;
    EXPECT_NEAR(std::abs(cosine), 1, 1e-6) << body;
  }
  // The camera looks along +X of the base: its optical frame's Z.
  const Pose X_BC =
      product(inverse(pose_in_world("cart/base")), pose_in_world("cart/eye_optical_frame"));
  EXPECT_NEAR(rotate_back(X_BC.q, {1, 0, 0}).z, 1, 1e-9);
  pose_in_world("roof");
  pose_in_world("cart/imu");
}

TEST_F(Topics, OdometryTurnsIntoTheBodysFrame) {
  const World world = world_of();
  table_ = *make_topic_table(world.compiled());
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  // Turned to +Y, moving along +Y of the world: ahead in its own frame.
  const double half = std::sqrt(.5);
  const SetJointState put{{0, 0}, {1, 2, 3, half, 0, 0, half}, {0, 2, 0, 0, 0, 0.5}};
  ASSERT_TRUE(simulation->post({.what = put}).ok());
  ASSERT_TRUE(simulation->step(1).ok());
  const Snapshot now = simulation->latest();
  auto solver = *PoseSolver::create(world.compiled());
  TopicInstant instant(now, *solver);
  const auto odom = message<nav_msgs::Odometry>("/cart/odom", instant);
  EXPECT_EQ(odom.child_frame_id, "cart/base");
  EXPECT_NEAR(odom.pose.pose.position.y, 2, 0.01);
  EXPECT_NEAR(odom.twist.twist.linear.x, 2, 0.05);
  EXPECT_NEAR(odom.twist.twist.linear.y, 0, 0.05);
  EXPECT_NEAR(odom.twist.twist.angular.z, 0.5, 0.05);
  EXPECT_EQ(odom.header.stamp, ros_time(now.time()));
}

TEST_F(Topics, StreamsDeliverMessagesOfAllSensorsWithOneStamp) {
  const World world = world_of(
      "[[camera]]\nname = \"wall\"\nposition = [-2, 0, 1]\nlook_at = [0, 0, 0]\n"
      "rate = 10\nwidth = 32\nheight = 24\n[render]\ntier = \"direct\"\nspp = 1\n");
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  TopicInbox inbox;
  {
    auto stream =
        *simulation->open_topics({.topics = {"/clock", "/tf*", "/cart/imu/imu", "/cart/range",
                                             "/cart/joint_states", "/wall/*", "/contacts"},
                                  .required = true},
                                 inbox.callback());
    ASSERT_TRUE(simulation->step(500).ok());
    ASSERT_TRUE(simulation->step(1).ok());
    EXPECT_TRUE(stream->status().ok());
    EXPECT_EQ(stream->dropped(), 0);
  }
  EXPECT_EQ(inbox.messages["/tf_static"].size(), 1u);
  EXPECT_NEAR(static_cast<double>(inbox.messages["/clock"].size()), 101, 1);
  EXPECT_NEAR(static_cast<double>(inbox.messages["/cart/joint_states"].size()), 51, 1);
  EXPECT_NEAR(static_cast<double>(inbox.messages["/wall/image_raw"].size()), 11, 1);
  EXPECT_EQ(inbox.steps["/wall/image_raw"], inbox.steps["/wall/camera_info"]);
  EXPECT_EQ(inbox.steps["/wall/image_raw"], inbox.steps["/wall/depth/image_rect_raw"]);

  const auto image = *decode<sensor_msgs::Image>(inbox.messages["/wall/image_raw"][5]);
  const auto info = *decode<sensor_msgs::CameraInfo>(inbox.messages["/wall/camera_info"][5]);
  EXPECT_EQ(image.header.stamp, info.header.stamp);
  EXPECT_EQ(image.header.frame_id, "wall_optical_frame");
  EXPECT_EQ(image.encoding, "rgb8");
  EXPECT_EQ(image.data.size(), 32u * 24 * 3);
  EXPECT_EQ(info.width, 32u);
  // A box at rest on the ground: the accelerometer shows +g upwards, the gyro nothing.
  const auto imu = *decode<sensor_msgs::Imu>(inbox.messages["/cart/imu/imu"].back());
  EXPECT_NEAR(imu.linear_acceleration.z, 9.81, 0.2);
  EXPECT_NEAR(imu.angular_velocity.x, 0, 0.05);
  EXPECT_EQ(imu.orientation_covariance[0], -1);
  EXPECT_NEAR(static_cast<double>(inbox.messages["/cart/imu/imu"].size()), 100, 2);
}

TEST_F(Topics, NobodyListensNothingIsMade) {
  const World world = world_of();
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  TopicInbox inbox;
  auto stream =
      *simulation->open_topics({.topics = {"/clock"}, .required = true}, inbox.callback());
  ASSERT_TRUE(simulation->step(50).ok());
  stream.reset();
  EXPECT_EQ(inbox.messages.size(), 1u);
  EXPECT_FALSE(simulation->open_topics({.topics = {"/nothing"}}, inbox.callback()).ok());
  EXPECT_FALSE(simulation->open_topics({.topics = {"/cart/cmd_vel"}}, inbox.callback()).ok());
}

TEST_F(Topics, GoOnThroughARecompile) {
  const World world = world_of(), other = world_of("[[push]]\nbody=\"cart/base\"\ntime=9\n");
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  TopicInbox inbox;
  auto stream = *simulation->open_topics(
      {.topics = {"/tf", "/cart/joint_states"}, .required = true}, inbox.callback());
  ASSERT_TRUE(simulation->step(100).ok());
  ASSERT_TRUE(simulation->recompile(other).ok());
  ASSERT_TRUE(simulation->step(100).ok());
  stream.reset();
  EXPECT_NEAR(static_cast<double>(inbox.messages["/tf"].size()), 21, 1);
}

// A reader that came before has the frames and the model of the World that runs.
TEST_F(Topics, LatchedOnesAreSentAgainInAnotherWorld) {
  std::string changed = kTopicScene;
  changed.replace(changed.find("0, 0, 0.3"), 9, "0, 0, 0.5");
  const World world = world_of();
  const World other = *World::compile(*parse_scene(changed, folder_.path()));
  auto simulation = *Simulation::create(world, {.pace = Pace::kLockstep});
  TopicInbox inbox;
  auto stream = *simulation->open_topics({.topics = {"/tf_static"}}, inbox.callback());
  auto closed = *simulation->open_topics({.topics = {"/cart/robot_description"}}, inbox.callback());
  closed.reset();
  ASSERT_TRUE(simulation->step(100).ok());
  const auto height = [&]() -> double {
    const tf2_msgs::TFMessage last = inbox.all<tf2_msgs::TFMessage>("/tf_static").back();
    for (const auto& frame : last.transforms)
      if (frame.child_frame_id == "roof") return frame.transform.translation.z;
    return NAN;
  };
  EXPECT_DOUBLE_EQ(height(), 0.3);
  ASSERT_TRUE(simulation->recompile(other).ok());
  EXPECT_EQ(inbox.steps["/tf_static"], (std::vector<int64_t>{0, 100}));
  EXPECT_DOUBLE_EQ(height(), 0.5);
  EXPECT_EQ(inbox.messages["/cart/robot_description"].size(), 1u) << "it was closed";
  stream.reset();
  ASSERT_TRUE(simulation->recompile(world).ok());
  EXPECT_EQ(inbox.messages["/tf_static"].size(), 2u);
}

class TopicInputs : public Topics {
 protected:
  TopicInputs() : world_(world_of()) {
    simulation_ = *Simulation::create(world_, {.pace = Pace::kLockstep});
  }
  template <class T>
  Status publish(const char* topic, const T& message) {
    MessageBytes bytes;
    encode(message, &bytes);
    return simulation_->publish(topic, bytes);
  }

  World world_;
  std::unique_ptr<Simulation> simulation_;
};

TEST_F(TopicInputs, JointCommandsBecomeGoals) {
  sensor_msgs::JointState command;
  command.name = {"lift"};
  command.position = {0.4};
  ASSERT_TRUE(publish("/cart/joint_command", command).ok());
  ASSERT_TRUE(simulation_->step(1).ok());
  const auto log = simulation_->take_command_log();
  ASSERT_EQ(log.size(), 1u);
  EXPECT_THAT(std::get<SetJointCommand>(log[0].command.what).position, ElementsAre(0.4));
  command.name = {"lfit"};
  EXPECT_THAT(publish("/cart/joint_command", command).error().to_string(), HasSubstr("lift"));
  command.name = {"lift"};
  command.position = {};
  EXPECT_FALSE(publish("/cart/joint_command", command).ok());
  command.velocity = {1};
  command.effort = {2};
  EXPECT_TRUE(publish("/cart/joint_command", command).ok());
  command.effort = {2, 3};
  EXPECT_FALSE(publish("/cart/joint_command", command).ok());
  command.effort = {std::nan("")};
  EXPECT_FALSE(publish("/cart/joint_command", command).ok());
}

TEST_F(TopicInputs, ControllersAreSetByTheirOptionsAsText) {
  ASSERT_TRUE(
      publish("/cart/set_controller", std_msgs::String{"type = 'joint_velocity'\nkp = 7"}).ok());
  ASSERT_TRUE(simulation_->step(1).ok());
  const auto log = simulation_->take_command_log();
  ASSERT_EQ(log.size(), 1u);
  const ControllerOptions& set = std::get<SetController>(log[0].command.what).controller;
  EXPECT_EQ(set.type, "joint_velocity");
  EXPECT_EQ(set.kp, 7);
  const auto error = [&](const char* text) {
    const Status status = publish("/cart/set_controller", std_msgs::String{text});
    return status.ok() ? std::string() : status.error().to_string();
  };
  EXPECT_THAT(error("type = 'joint_velocty'"), HasSubstr("'joint_velocity'"));
  EXPECT_THAT(error("type = 'joint_velocity'\nkq = 7"), HasSubstr("'kp'"));
  EXPECT_THAT(error("type = 'joint_velocity'\nkp = -7"), HasSubstr("kp"));
  EXPECT_THAT(error("type = 'joint_velocity'\ntarget = [1]"), HasSubstr("target"));
  EXPECT_THAT(error("type ="), HasSubstr("controller"));
  EXPECT_THAT(error("type = 'joint_velocity'\nrate = 333"), HasSubstr("does not divide"));
}

TEST_F(TopicInputs, ArraysAreGoalsOfAllJointsAndStampsOfVelocitiesAreLeftOut) {
  std_msgs::Float64MultiArray goals;
  goals.data = {0.25};
  ASSERT_TRUE(publish("/cart/position_commands", goals).ok());
  ASSERT_TRUE(
      publish("/cart/cmd_vel_stamped", geometry_msgs::TwistStamped{{}, {{0.5, 0, 0}, {0, 0, 0.1}}})
          .ok());
  ASSERT_TRUE(simulation_->step(1).ok());
  const auto log = simulation_->take_command_log();
  ASSERT_EQ(log.size(), 2u);
  EXPECT_THAT(std::get<SetJointCommand>(log[0].command.what).position, ElementsAre(0.25));
  EXPECT_EQ(std::get<SetVelocityGoal>(log[1].command.what).yaw_rate, 0.1);
  goals.data = {0.25, 0.5};
  EXPECT_FALSE(publish("/cart/position_commands", goals).ok());
}

TEST_F(TopicInputs, APoseGoalIsInTheWorld) {
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = "world";
  goal.pose = {{0.1, 0.2, 0.3}, {0, 1, 0, 0}};
  ASSERT_TRUE(publish("/cart/pose_goal", goal).ok());
  ASSERT_TRUE(simulation_->step(1).ok());
  const auto log = simulation_->take_command_log();
  ASSERT_EQ(log.size(), 1u);
  const Pose X_WF = std::get<SetPoseGoal>(log[0].command.what).X_WF;
  EXPECT_EQ(X_WF, (Pose{{0.1, 0.2, 0.3}, {0, 0, 1, 0}}));  // x y z w -> w x y z
  goal.header.frame_id = "tool";
  EXPECT_THAT(publish("/cart/pose_goal", goal).error().to_string(), HasSubstr("'world'"));
  goal.header.frame_id = "";
  goal.pose.orientation = {0, 0, 0, 0};
  EXPECT_FALSE(publish("/cart/pose_goal", goal).ok());
}

TEST_F(TopicInputs, AnInitialPosePutsAFloatingRobotThereAtRest) {
  geometry_msgs::PoseWithCovarianceStamped there;
  there.pose.pose.position = {1, 2, 3};
  ASSERT_TRUE(publish("/cart/initialpose", there).ok());
  ASSERT_TRUE(simulation_->step(1).ok());
  EXPECT_NEAR(simulation_->body_pose({1, 0})->p.x, 1, 1e-3);
  there.pose.pose.orientation.w = 0;
  EXPECT_FALSE(publish("/cart/initialpose", there).ok());
  there.pose.pose.orientation.w = 1;
  there.header.frame_id = "map";
  EXPECT_FALSE(publish("/cart/initialpose", there).ok());
}

TEST_F(TopicInputs, TrajectoriesAreFollowedFromTheirStamps) {
  trajectory_msgs::JointTrajectory way;
  way.header.stamp.nanosec = 50'000'000;
  way.joint_names = {"lift"};
  way.points.resize(2);
  way.points[0].positions = {0.2};
  way.points[0].time_from_start = {0, 100000000};
  way.points[1].positions = {0.1};
  way.points[1].time_from_start = {0, 200000000};
  ASSERT_TRUE(publish("/cart/joint_trajectory", way).ok());
  ASSERT_TRUE(simulation_->step(150).ok());
  const auto log = simulation_->take_command_log();
  ASSERT_EQ(log.size(), 1u);
  const Snapshot now = simulation_->latest();
  const auto active = now.trajectory(Robot{0, 0});
  ASSERT_NE(active, nullptr);
  EXPECT_NEAR(active->start_time, 0.05, 1e-9);
  // It starts where the joint is, which sags a little.
  EXPECT_NEAR(active->at(0.1, 0).position, (0.2 + active->at(0.05, 0).position) / 2, 1e-9);
  EXPECT_NEAR(active->at(0.2, 0).position, 0.15, 1e-9);
  way.header.stamp = {};
  way.points[1].positions = {0.15};
  ASSERT_TRUE(publish("/cart/joint_trajectory", way).ok());
  ASSERT_TRUE(simulation_->step(1).ok());
  const auto next = simulation_->latest().trajectory(Robot{0, 0});
  EXPECT_EQ(next->start_step, 150) << "it replaces the first";
  EXPECT_NEAR(next->at(next->start_time, 0).position, active->at(next->start_time, 0).position,
              1e-12);
  way.points[1].time_from_start = {0, 0};
  EXPECT_FALSE(publish("/cart/joint_trajectory", way).ok());  // back in time
}

TEST_F(TopicInputs, ATrajectoryWithoutPointsStopsTheJoints) {
  trajectory_msgs::JointTrajectory way;
  way.joint_names = {"lift"};
  way.points = {{.positions = {0.2}, .time_from_start = {1, 0}}};
  trajectory_msgs::JointTrajectory stop;
  const auto is_moving = [&] { return simulation_->latest().trajectory(Robot{0, 0}) != nullptr; };
  for (const bool is_named : {false, true}) {
    ASSERT_TRUE(publish("/cart/joint_trajectory", way).ok());
    ASSERT_TRUE(simulation_->step(50).ok());
    EXPECT_TRUE(is_moving());
    stop.joint_names.clear();
    if (is_named) stop.joint_names = {"lift"};
    stop.header.stamp.nanosec = 1;  // past, as stamps of a publisher always are
    ASSERT_TRUE(publish("/cart/joint_trajectory", stop).ok());
    ASSERT_TRUE(simulation_->step(1).ok());
    EXPECT_FALSE(is_moving());
  }
  // Also one that has not started.
  way.header.stamp.sec = 1;
  ASSERT_TRUE(publish("/cart/joint_trajectory", way).ok());
  ASSERT_TRUE(publish("/cart/joint_trajectory", stop).ok());
  ASSERT_TRUE(simulation_->step(1000).ok());
  EXPECT_GT(simulation_->latest().time(), 1.01);
  EXPECT_FALSE(is_moving());
  stop.joint_names = {"knee"};
  EXPECT_FALSE(publish("/cart/joint_trajectory", stop).ok());
}

TEST_F(TopicInputs, StampsOfTrajectoriesAreSimulationTime) {
  ASSERT_TRUE(simulation_->step(500).ok());
  trajectory_msgs::JointTrajectory way;
  way.joint_names = {"lift"};
  way.points = {{.positions = {0.2}, .time_from_start = {0, 50000000}}};
  const auto error_at = [&](int32_t seconds, uint32_t nanoseconds) {
    way.header.stamp = {seconds, nanoseconds};
    const Status status = publish("/cart/joint_trajectory", way);
    return status.ok() ? std::string("accepted") : status.error().to_string();
  };
  const double now = simulation_->latest().time();
  ASSERT_GT(now, 0.2);
  EXPECT_THAT(error_at(0, 100000000), HasSubstr("ended at 0.15 s"));
  EXPECT_THAT(error_at(1'700'000'000, 0), HasSubstr("use_sim_time"));
  EXPECT_EQ(error_at(0, static_cast<uint32_t>(1e9 * (now - 0.02))), "accepted");
  ASSERT_TRUE(simulation_->step(1).ok());
  EXPECT_EQ(simulation_->latest().trajectory(Robot{0, 0})->start_step, 500) << "not skipped";
}

TEST_F(TopicInputs, TrajectoriesAndCommandsOfJointsAreChecked) {
  trajectory_msgs::JointTrajectory good;
  good.joint_names = {"lift"};
  good.points.resize(1);
  good.points[0].positions = {0.2};
  good.points[0].time_from_start.sec = 1;
  const char* const name = "/cart/joint_trajectory";
  const auto refused = [&](auto change) {
    trajectory_msgs::JointTrajectory way = good;
    change(way);
    return !publish(name, way).ok();
  };
  using Way = trajectory_msgs::JointTrajectory;
  EXPECT_TRUE(refused([](Way& way) { way.joint_names = {"lift", "lift"}; }));
  EXPECT_TRUE(refused([](Way& way) {
    way.joint_names = {"lift", "lift"};
    way.points[0].positions = {0.1, 0.2};
  }));
  EXPECT_TRUE(refused([](Way& way) { way.joint_names = {"knee"}; }));
  EXPECT_TRUE(refused([](Way& way) { way.joint_names = {""}; }));
  EXPECT_TRUE(refused([](Way& way) { way.joint_names.clear(); }));
  EXPECT_TRUE(refused([](Way& way) { way.points[0].positions = {std::nan("")}; }));
  EXPECT_TRUE(refused([](Way& way) { way.points[0].velocities = {1, 2}; }));
  EXPECT_TRUE(refused([](Way& way) { way.points[0].accelerations = {1, 2}; }));
  EXPECT_TRUE(refused([](Way& way) { way.points[0].time_from_start.sec = -1; }));
  EXPECT_TRUE(refused([](Way& way) { way.points.push_back(way.points[0]); }));
  EXPECT_TRUE(publish(name, good).ok());
  sensor_msgs::JointState twice;
  twice.name = {"lift", "lift"};
  twice.position = {0.1, 0.2};
  EXPECT_FALSE(publish("/cart/joint_command", twice).ok());
}

TEST_F(TopicInputs, EveryOtherInputIsHeard) {
  EXPECT_TRUE(publish("/cart/cmd_vel", geometry_msgs::Twist{{0.5, 0, 0}, {0, 0, 0.1}}).ok());
  std_msgs::Float64MultiArray controls;
  controls.data = {0.3};
  EXPECT_TRUE(publish("/cart/controls", controls).ok());
  controls.data = {0.3, 0.4};
  EXPECT_FALSE(publish("/cart/controls", controls).ok());
  geometry_msgs::WrenchStamped wrench;
  wrench.wrench.force = {0, 0, 5};
  EXPECT_TRUE(publish("/cart/wrench_command", wrench).ok());
  wrench.header.frame_id = "cart/base";
  EXPECT_FALSE(publish("/cart/wrench_command", wrench).ok());
  ASSERT_TRUE(simulation_->step(5).ok());
  EXPECT_EQ(simulation_->take_command_log().size(), 3u);
  EXPECT_TRUE(publish("/reset", std_msgs::Empty{}).ok());
  EXPECT_EQ(simulation_->latest().step(), 0);
  const std::vector<uint8_t> damaged = {0, 1, 0, 0, 1};
  EXPECT_FALSE(simulation_->publish("/cart/cmd_vel", damaged).ok());
  EXPECT_FALSE(simulation_->publish("/clock", damaged).ok());
  EXPECT_FALSE(simulation_->publish("/nothing", damaged).ok());
}

}  // namespace
}  // namespace gloam

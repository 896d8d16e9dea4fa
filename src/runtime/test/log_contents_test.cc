// Contents of logs: channels that every reader takes, Commands as messages of input topics, and
// logs of the form that was written before.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "gloam/controller.h"
#include "gloam/log.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"
#include "ros/codec.h"
#include "ros/messages/sensor_msgs.h"
#include "ros/messages/trajectory_msgs.h"
#include "runtime/live/live_simulation.h"
#include "runtime/log/log_recorder.h"
#include "runtime/log/logged_text.h"
#include "runtime/log/run_text.h"
#include "scene/test/temp_folder.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using testing::DoubleEq;
using testing::ElementsAre;

constexpr const char* kMover = R"(<mujoco model="mover"><option timestep="0.002"/>
<worldbody><light pos="0 0 3"/><geom type="plane" size="3 3 .1"/>
<body name="base" pos="0 0 .5"><freejoint name="free"/><geom type="box" size=".1 .1 .1" mass="1"/>
  <body name="arm" pos="0 0 .1"><joint name="shoulder" axis="0 1 0" damping=".1"/>
  <geom type="capsule" size=".03" fromto="0 0 0 .3 0 0"/>
  <body name="fore" pos=".3 0 0"><joint name="elbow" axis="0 1 0" damping=".1"/>
  <geom type="capsule" size=".03" fromto="0 0 0 .2 0 0"/></body></body></body>
<body name="hand" mocap="true" pos="-1 0 1"><geom size=".05" contype="0" conaffinity="0"/></body>
</worldbody><actuator><motor name="s" joint="shoulder"/><motor name="e" joint="elbow"/></actuator>
</mujoco>)";

constexpr const char* kLoggedScene = R"([[robot]]
name = "go"
file = "mover.xml"
[[robot]]
name = "held"
file = "mover.xml"
position = [3, 0, 0]
[robot.controller]
type = "joint_position"
[[robot]]
name = "led"
file = "mover.xml"
position = [0, 3, 0]
[robot.controller]
type = "idle_in_logs"
goals = [{time = 0.02, vx = 0.4}, {time = 0.04, vx = 0.1, yaw_rate = 0.3}]
)";

struct Idle final : Controller {
  void reset(const mjModel_*, const mjData_*) override {}
  void control(const ControlInputs&) override {}
};

struct Logged {
  double time = 0;  // log time [s]
  std::vector<uint8_t> data;
  std::string type;
};

class LogContents : public testing::Test {
 protected:
  LogContents() {
    // Each test of the process but the first finds it registered.
    static_cast<void>(register_controller("idle_in_logs", [](const ControllerRequest&) {
      return Result<std::unique_ptr<Controller>>(std::make_unique<Idle>());
    }));
    folder_.write("mover.xml", kMover);
    folder_.write("s.toml", kLoggedScene);
    file_ = folder_.path() / "run.mcap";
    world_ = std::make_unique<World>(*World::compile(*load_scene(folder_.path() / "s.toml")));
    live_ = *LiveSimulation::create(*world_, {.seed = 7, .pace = Pace::kLockstep});
  }
  void record(std::vector<std::string> topics = {}) {
    log_ = *LogRecorder::start(*live_, {.file = file_, .topics = std::move(topics)});
  }
  void post(auto what) { ASSERT_TRUE(live_->post({.what = std::move(what)}).ok()); }
  void step(int64_t count) { ASSERT_TRUE(live_->step(count).ok()); }
  void finish() {
    live_->simulator().stop();
    ASSERT_TRUE(log_->finish(live_->latest()).ok());
  }
  std::map<std::string, std::vector<Logged>> read() const {
    std::map<std::string, std::vector<Logged>> all;
    const McapReader log = *McapReader::open(file_);
    McapMessages messages = log.messages();
    for (const McapMessage* m = *messages.next(); m != nullptr; m = *messages.next()) {
      const McapChannel& channel = log.channels().at(m->channel);
      all[channel.topic].push_back({1e-9 * static_cast<double>(m->log_time),
                                    {m->data.begin(), m->data.end()},
                                    log.schemas().at(channel.schema).name});
    }
    return all;
  }
  template <class T>
  static std::vector<std::pair<double, T>> decoded(const std::vector<Logged>& messages) {
    std::vector<std::pair<double, T>> all;
    for (const Logged& message : messages) {
      EXPECT_EQ(message.type, type_name<T>());
      all.emplace_back(message.time, *decode<T>(message.data));
    }
    return all;
  }

  TempFolder folder_;
  fs::path file_;
  std::unique_ptr<World> world_;
  std::unique_ptr<LiveSimulation> live_;
  std::unique_ptr<LogRecorder> log_;
};

TEST_F(LogContents, EveryChannelIsCdrWithASchema) {
  record();
  post(SetWrench{*world_->find_body("go/base"), {0, 0, 1}, {}});
  step(20);
  finish();
  const McapReader log = *McapReader::open(file_);
  EXPECT_GT(log.channels().size(), 6u);
  for (const auto& [id, channel] : log.channels()) {
    EXPECT_EQ(channel.encoding, "cdr") << channel.topic;
    ASSERT_TRUE(log.schemas().contains(channel.schema)) << channel.topic;
    EXPECT_EQ(log.schemas().at(channel.schema).encoding, "ros2msg");
    EXPECT_TRUE(channel.metadata.contains("offered_qos_profiles")) << channel.topic;
  }
}

TEST_F(LogContents, CommandsAreMessagesOfTheInputTopicsAtTheirSteps) {
  record();
  step(5);
  post(SetControls{world_->robots()[0].robot, {0.7, -0.2}});
  step(5);
  post(SetControl{*world_->find_actuator("go/e"), 0.9});
  post(SetVelocityGoal{world_->robots()[1].robot, 1, 2, 3});
  post(SetJointGoal{*world_->find_joint("held/elbow"), 0.25});
  post(SetJointGoal{*world_->find_joint("held/shoulder"), -0.5});
  post(SetWrench{*world_->find_body("go/base"), {0, 0, 12}, {0, 1, 0}});
  post(SetMocapPose{*world_->find_body("go/hand"), {{1, 2, 3}, {0, 1, 0, 0}}});
  post(SetJointState{*world_->find_joint("go/free"), {4, 5, 6, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 0}});
  step(20);
  post(ResetSim{});
  step(5);
  finish();
  auto all = read();
  const auto controls = decoded<std_msgs::Float64MultiArray>(all["/go/controls"]);
  ASSERT_EQ(controls.size(), 2u);
  EXPECT_NEAR(controls[0].first, 0.010, 1e-9);
  EXPECT_THAT(controls[0].second.data, ElementsAre(0.7, -0.2));
  EXPECT_NEAR(controls[1].first, 0.020, 1e-9);
  EXPECT_THAT(controls[1].second.data, ElementsAre(0.7, 0.9)) << "the other one stays";
  const auto goals = decoded<sensor_msgs::JointState>(all["/held/joint_command"]);
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_THAT(goals[0].second.name, ElementsAre("shoulder", "elbow"));
  EXPECT_THAT(goals[0].second.position, ElementsAre(-0.5, 0.25));
  EXPECT_EQ(goals[0].second.header.stamp.nanosec, 20000000u);
  const auto wrench = decoded<geometry_msgs::WrenchStamped>(all["/go/wrench_command"]);
  ASSERT_EQ(wrench.size(), 1u);
  EXPECT_EQ(wrench[0].second.wrench.force.z, 12);
  EXPECT_EQ(wrench[0].second.wrench.torque.y, 1);
  const auto pose = decoded<geometry_msgs::PoseStamped>(all["/go/hand/pose"]);
  ASSERT_EQ(pose.size(), 1u);
  EXPECT_EQ(pose[0].second.pose.position.z, 3);
  EXPECT_EQ(pose[0].second.pose.orientation.x, 1);
  const auto put = decoded<geometry_msgs::PoseWithCovarianceStamped>(all["/go/initialpose"]);
  ASSERT_EQ(put.size(), 1u);
  EXPECT_EQ(put[0].second.pose.pose.position.y, 5);
  ASSERT_EQ(all["/reset"].size(), 1u);
  EXPECT_EQ(all["/reset"][0].type, "std_msgs/msg/Empty");
  EXPECT_NEAR(all["/reset"][0].time, 0.06, 1e-9);
  EXPECT_EQ(all["/gloam/commands"].size(), 9u) << "as Commands, too";
}

TEST_F(LogContents, GoalsOfTheSceneAreCommandsLikeAnyOthers) {
  record();
  step(30);
  finish();
  auto all = read();
  const auto goals = decoded<geometry_msgs::Twist>(all["/led/cmd_vel"]);
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_NEAR(goals[0].first, 0.02, 1e-9);
  EXPECT_EQ(goals[0].second.linear.x, 0.4);
  EXPECT_NEAR(goals[1].first, 0.04, 1e-9);
  EXPECT_EQ(goals[1].second.angular.z, 0.3);
}

TEST_F(LogContents, MessagesThatWerePublishedAreLogged) {
  record();
  step(5);
  std::vector<uint8_t> bytes;
  geometry_msgs::TwistStamped twist;
  twist.twist.linear.x = 0.5;
  encode(twist, &bytes);
  ASSERT_TRUE(live_->publish("/held/cmd_vel_stamped", bytes).ok());
  encode(std_msgs::Float64MultiArray{{}, {0.1, 0.2}}, &bytes);
  ASSERT_TRUE(live_->publish("/held/position_commands", bytes).ok());
  trajectory_msgs::JointTrajectory way;
  way.joint_names = {"elbow"};
  way.points = {{.positions = {0.4}, .time_from_start = {0, 20000000}}};
  encode(way, &bytes);
  ASSERT_TRUE(live_->publish("/held/joint_trajectory", bytes).ok());
  step(20);
  finish();
  auto all = read();
  EXPECT_EQ(decoded<geometry_msgs::TwistStamped>(all["/held/cmd_vel_stamped"])[0].second, twist);
  EXPECT_EQ(decoded<trajectory_msgs::JointTrajectory>(all["/held/joint_trajectory"])[0].second,
            way);
  const auto positions = decoded<std_msgs::Float64MultiArray>(all["/held/position_commands"]);
  ASSERT_EQ(positions.size(), 1u);
  EXPECT_NEAR(positions[0].first, 0.01, 1e-9);
  EXPECT_THAT(positions[0].second.data, ElementsAre(0.1, 0.2));
  // The goals at the steps at which they applied.
  EXPECT_EQ(decoded<geometry_msgs::Twist>(all["/held/cmd_vel"])[0].second.linear.x, 0.5);
  const auto goals = decoded<sensor_msgs::JointState>(all["/held/joint_command"]);
  ASSERT_EQ(goals.size(), 1u) << "a trajectory is no series of goals";
  EXPECT_THAT(goals[0].second.position, ElementsAre(0.1, 0.2));
}

TEST_F(LogContents, ControlsThatAHookWritesAreLogged) {
  ASSERT_TRUE(live_
                  ->set_step_hook([](const mjModel_*, mjData_* d) {
                    if (d->time > 0.0099) d->ctrl[1] = std::floor(d->time * 100 + 0.01);
                  })
                  .ok());
  record({"/go/controls"});
  step(15);
  finish();
  const auto controls = decoded<std_msgs::Float64MultiArray>(read()["/go/controls"]);
  ASSERT_EQ(controls.size(), 2u) << "at the steps at which they changed";
  EXPECT_NEAR(controls[0].first, 0.01, 1e-9);
  EXPECT_THAT(controls[0].second.data, ElementsAre(0, DoubleEq(1)));
  EXPECT_NEAR(controls[1].first, 0.02, 1e-9);
  EXPECT_THAT(controls[1].second.data, ElementsAre(0, DoubleEq(2)));
}

TEST_F(LogContents, OnlyTopicsThatAreAskedForAreInIt) {
  record({"/clock"});
  post(SetControls{world_->robots()[0].robot, {0.7, 0}});
  step(20);
  finish();
  EXPECT_EQ(read().count("/go/controls"), 0u);
}

// A log as Gloam wrote it before: texts are bare JSON on channels without a schema, paths absolute,
// files embedded by their absolute names.
std::string old_form(const std::string& json_text, const fs::path& folder, const mjModel& model) {
  auto json = nlohmann::ordered_json::parse(json_text);
  for (const char* key : {"format", "packages", "has_root"}) json.erase(key);
  json["folder"] = folder.string();
  std::vector<std::byte> bytes(static_cast<size_t>(mj_sizeModel(&model)));
  mj_saveModel(&model, nullptr, bytes.data(), static_cast<int>(bytes.size()));
  json["model_hash"] = hash_to_hex(hash_bytes(bytes.data(), bytes.size()));
  return json.dump();
}

void write_old_form(const fs::path& from, const fs::path& to, const mjModel& model) {
  const McapReader log = *McapReader::open(from);
  McapWriter writer(*FileSink::create(to));
  for (const auto& [id, schema] : log.schemas()) ASSERT_TRUE(writer.add_schema(schema).ok());
  for (const auto& [id, channel] : log.channels()) {
    McapChannel old = channel;
    if (channel.topic == kWorldTopic || channel.topic == kCommandTopic) {
      old.schema = 0;
      old.encoding = "json";
      old.metadata.clear();
    }
    ASSERT_TRUE(writer.add_channel(old).ok());
  }
  McapMessages messages = log.messages();
  for (const McapMessage* m = *messages.next(); m != nullptr; m = *messages.next()) {
    const std::string& topic = log.channels().at(m->channel).topic;
    McapMessage old = *m;
    std::string text;
    if (topic == kWorldTopic || topic == kCommandTopic) text = *logged_text(log, *m);
    if (topic == kWorldTopic) text = old_form(text, from.parent_path(), model);
    if (!text.empty()) old.data = {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
    ASSERT_TRUE(writer.add_message(old).ok());
  }
  ASSERT_TRUE(writer.finish().ok());
}

TEST_F(LogContents, LogsOfTheFormBeforeAreRead) {
  record();
  post(SetControls{world_->robots()[0].robot, {0.7, -0.2}});
  step(60);
  finish();
  const fs::path old = folder_.path() / "old.mcap";
  write_old_form(file_, old, *world_->compiled()->model);
  EXPECT_TRUE(describe_log(old)->has_run);
  const auto found = verify_log(old, "", {});
  ASSERT_TRUE(found.ok()) << found.error().to_string();
  EXPECT_TRUE(found->is_equal()) << found->where;
  EXPECT_EQ(found->steps, 60);
}

TEST_F(LogContents, ALogTellsNothingOfItsMachine) {
  log_ = *LogRecorder::start(*live_, {.file = file_, .embed = true});
  step(10);
  finish();
  const McapReader log = *McapReader::open(file_);
  McapMessages messages = log.messages();
  for (const McapMessage* m = *messages.next(); m != nullptr; m = *messages.next()) {
    const std::string text(m->data.begin(), m->data.end());
    EXPECT_EQ(text.find(folder_.path().parent_path().string()), std::string::npos);
  }
  ASSERT_EQ(log.attachments().size(), 1u);
  EXPECT_EQ(log.attachments()[0].name, "mover.xml");
}

TEST_F(LogContents, AStrangersLogCannotNameFilesOutsideItsFolder) {
  record();
  step(5);
  finish();
  const McapReader log = *McapReader::open(file_);
  McapMessages messages = log.messages({.topics = {kWorldTopic}});
  RunText text = *parse_run_text(*logged_text(log, **messages.next()));
  EXPECT_EQ(text.format, 2);
  ASSERT_EQ(text.files.size(), 1u);
  EXPECT_EQ(text.files[0].path, "mover.xml");
}

}  // namespace
}  // namespace gloam

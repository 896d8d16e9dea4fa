// The bridge to ROS 2 in one process: names, endpoints, what is computed for whom, and masters.
// Real rclpy talks to it in tests/e2e/ros2_test.py.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#include "base/test/source_dir.h"
#include "bridge/ros2/dds_node.h"
#include "bridge/ros2/ros2_names.h"
#include "bridge/ros2/topic_inlets.h"
#include "gloam/bridge.h"
#include "ros/codec.h"
#include "ros/messages/geometry_msgs.h"

namespace gloam::bridge {
namespace {

bool comes_true(const std::function<bool()>& condition, std::chrono::seconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return condition();
}

// Writes a message again and again until it has had its effect.
bool says_until(DdsWriter& writer, const std::vector<uint8_t>& message,
                const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    writer.write(message);
    if (comes_true(condition, std::chrono::seconds(1))) return true;
  }
  return false;
}

// Tests of several processes do not meet.
int test_domain(int offset) { return 20 + (static_cast<int>(getpid()) + offset * 31) % 80; }

TEST(Ros2Names, AreThoseOfRmw) {
  EXPECT_EQ(dds_topic("/cam/image_raw"), "rt/cam/image_raw");
  EXPECT_EQ(dds_request("/sim/step"), "rq/sim/stepRequest");
  EXPECT_EQ(dds_reply("/sim/step"), "rr/sim/stepReply");
  EXPECT_EQ(dds_type("std_msgs/msg/String"), "std_msgs::msg::dds_::String_");
  EXPECT_EQ(dds_type("std_srvs/srv/Empty", "_Request"), "std_srvs::srv::dds_::Empty_Request_");
  EXPECT_EQ(ros_name("sim 1.b"), "sim_1_b");
}

TEST(DdsNode, BytesArriveAsTheyWereSentWhateverTheirSize) {
  const DdsNodeOptions options{.domain = test_domain(0)};
  const auto here = *DdsNode::create(options), there = *DdsNode::create(options);
  std::mutex mutex;
  std::vector<std::vector<uint8_t>> got;
  const DdsEndpoint endpoint{
      .topic = "rt/bytes", .type = "a::msg::dds_::B_", .qos = {.depth = 100}, .is_large = true};
  const auto reader = *there->add_reader(endpoint, [&](const DdsSample& sample) {
    const std::lock_guard lock(mutex);
    got.emplace_back(sample.data.begin(), sample.data.end());
  });
  std::atomic<int> matches{0};
  const auto writer = *here->add_writer(endpoint, [&] { ++matches; });
  ASSERT_TRUE(comes_true([&] { return writer->readers() == 1; }, std::chrono::seconds(20)));
  EXPECT_GE(matches, 1);
  std::vector<std::vector<uint8_t>> sent;
  for (const size_t size : {5u, 4096u, 300'000u, 2'000'000u}) {
    std::vector<uint8_t> bytes(size);
    for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(i * 7 + i / 251);
    EXPECT_TRUE(writer->write(bytes));
    sent.push_back(std::move(bytes));
  }
  EXPECT_TRUE(comes_true(
      [&] {
        const std::lock_guard lock(mutex);
        return got.size() == sent.size();
      },
      std::chrono::seconds(20)));
  EXPECT_EQ(got, sent);
}

TEST(DdsNode, LateReadersGetLatchedMessages) {
  const DdsNodeOptions options{.domain = test_domain(1)};
  const auto here = *DdsNode::create(options), there = *DdsNode::create(options);
  const DdsEndpoint endpoint{
      .topic = "rt/latched", .type = "a::msg::dds_::B_", .qos = {.is_latched = true, .depth = 1}};
  const auto writer = *here->add_writer(endpoint);
  writer->write(std::vector<uint8_t>{0, 1, 0, 0, 7});
  writer->write(std::vector<uint8_t>{0, 1, 0, 0, 8});
  std::atomic<int> last{0}, count{0};
  const auto reader = *there->add_reader(endpoint, [&](const DdsSample& sample) {
    last = sample.data[4];
    ++count;
  });
  EXPECT_TRUE(comes_true([&] { return last == 8; }, std::chrono::seconds(20)));
  EXPECT_EQ(count, 1);
}

constexpr const char* kBridgeScene = R"(
[scene]
name = "small"
[[robot]]
name = "quadruped"
file = "assets/robots/quadruped/quadruped.xml"
keyframe = "home"
[robot.controller]
type = "trot"
)";

class Ros2BridgeTest : public ::testing::Test {
 protected:
  Ros2BridgeTest()
      : world_(*World::compile(*parse_scene(kBridgeScene, source_dir()))),
        simulation_(*Simulation::create(world_, {.pace = Pace::kRealTime})) {}

  World world_;
  std::unique_ptr<Simulation> simulation_;
};

TEST_F(Ros2BridgeTest, NobodySubscribesNothingIsSent) {
  const int domain = test_domain(2);
  BridgeOptions options;
  options.ros2 = Ros2Options{.domain = domain};
  const auto bridges = *Bridges::start(*simulation_, options);
  const Bridge& bridge = *bridges->list().front();
  simulation_->resume();
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  EXPECT_EQ(bridge.stats().messages_out, 0);
  const auto listener = *DdsNode::create({.domain = domain, .node = "listener"});
  std::atomic<int> heard{0};
  auto reader = *listener->add_reader({.topic = "rt/clock",
                                       .type = "rosgraph_msgs::msg::dds_::Clock_",
                                       .qos = {.is_reliable = false}},
                                      [&](const DdsSample&) { ++heard; });
  EXPECT_TRUE(comes_true([&] { return heard > 20; }, std::chrono::seconds(20)));
  EXPECT_EQ(bridge.stats().clients, 1);
  reader.reset();  // its stream is kept for two seconds
  EXPECT_TRUE(comes_true([&] { return bridge.stats().clients == 0; }, std::chrono::seconds(20)));
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  const int64_t after = bridge.stats().messages_out;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(bridge.stats().messages_out, after);
}

TEST_F(Ros2BridgeTest, DamagedMessagesAreRefusedAndCounted) {
  const int domain = test_domain(3);
  BridgeOptions options;
  options.ros2 = Ros2Options{.domain = domain};
  const auto bridges = *Bridges::start(*simulation_, options);
  const auto talker = *DdsNode::create({.domain = domain, .node = "talker"});
  const auto writer = *talker->add_writer(
      {.topic = "rt/quadruped/cmd_vel", .type = "geometry_msgs::msg::dds_::Twist_"});
  ASSERT_TRUE(comes_true([&] { return writer->readers() == 1; }, std::chrono::seconds(20)));
  const auto before = simulation_->stats().commands_applied;
  const Bridge& bridge = *bridges->list().front();
  writer->write(std::vector<uint8_t>());  // DDS delivers no data, so the bridge has none to reject
  // One at a time: a reader keeps the last ten messages only, and may discover the writer late.
  for (size_t size = 1; size < 52; ++size) {  // a Twist has 4 + 48 bytes
    std::vector<uint8_t> bytes(size, 0xff);
    if (size > 1) bytes[0] = 0, bytes[1] = 1;
    const int64_t refused = bridge.stats().refused;
    ASSERT_TRUE(says_until(*writer, bytes, [&] { return bridge.stats().refused > refused; }))
        << size << " bytes";
  }
  const int64_t refused = bridge.stats().refused;
  EXPECT_TRUE(says_until(*writer, std::vector<uint8_t>(52, 0xff), [&] {
    return bridge.stats().refused > refused;
  })) << "no CDR header";
  EXPECT_EQ(bridge.stats().messages_in, 0);
  EXPECT_TRUE(simulation_->step(2).ok());
  EXPECT_EQ(simulation_->stats().commands_applied, before);
  std::vector<uint8_t> good;
  encode(geometry_msgs::Twist{{0.3, 0, 0}, {}}, &good);
  EXPECT_TRUE(says_until(*writer, good, [&] { return bridge.stats().messages_in >= 1; }));
}

TEST_F(Ros2BridgeTest, ASilentMasterLosesItsRobotWhichThenStands) {
  const auto node = *DdsNode::create({.domain = test_domain(4)});
  TopicInlets inlets(*simulation_, *node);
  std::vector<TopicInfo> inputs;
  const auto topics = *simulation_->topics();
  for (const TopicInfo& topic : topics)
    if (topic.is_input) inputs.push_back(topic);
  ASSERT_TRUE(inlets.set_topics(inputs).ok());
  const auto talker = *DdsNode::create({.domain = test_domain(4), .node = "talker"});
  const auto writer = *talker->add_writer(
      {.topic = "rt/quadruped/cmd_vel", .type = "geometry_msgs::msg::dds_::Twist_"});
  ASSERT_TRUE(comes_true([&] { return writer->readers() == 1; }, std::chrono::seconds(20)));
  std::vector<uint8_t> forward;
  encode(geometry_msgs::Twist{{0.3, 0, 0}, {}}, &forward);
  simulation_->resume();
  ASSERT_TRUE(says_until(*writer, forward, [&] { return inlets.heard() >= 1; }));
  const Robot robot = *world_.find_robot("quadruped");
  EXPECT_FALSE(simulation_->claim(robot).ok()) << "it has a master";
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  inlets.release_silent();
  EXPECT_TRUE(simulation_->claim(robot).ok());
  // Two copies of the message may have arrived: the goal that stops the robot is the last one.
  EXPECT_TRUE(comes_true(
      [&] {
        const auto log = simulation_->take_command_log();
        return !log.empty() && std::get<SetVelocityGoal>(log.back().command.what).vx == 0;
      },
      std::chrono::seconds(20)));
  EXPECT_GE(simulation_->stats().commands_applied, 2);
}

}  // namespace
}  // namespace gloam::bridge

// Clients of the bridge to ROS 2: one in C++ on the same DDS, and rclpy.

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "bench/latency/latency.h"
#include "bridge/ros2/dds_node.h"
#include "bridge/ros2/ros2_names.h"

namespace gloam::latency {
namespace {

// The stamp that nearly every message begins with, behind the head of its CDR [ns]; 0 = too short.
uint64_t first_stamp(std::span<const uint8_t> data) {
  if (data.size() < 12) return 0;
  int32_t seconds = 0;
  uint32_t nanoseconds = 0;
  std::memcpy(&seconds, data.data() + 4, sizeof seconds);
  std::memcpy(&nanoseconds, data.data() + 8, sizeof nanoseconds);
  return static_cast<uint64_t>(seconds) * 1'000'000'000u + nanoseconds;
}

int domain_of_environment() {
  const char* text = std::getenv("ROS_DOMAIN_ID");
  return text != nullptr ? std::atoi(text) : 0;
}

std::string type_of(const std::string& topic) {
  const auto ends_with = [&](const char* end) { return topic.ends_with(end); };
  if (ends_with("joint_states")) return "sensor_msgs/msg/JointState";
  if (ends_with("compressed")) return "sensor_msgs/msg/CompressedImage";
  return "sensor_msgs/msg/Image";
}

}  // namespace

int run_ros2_client(const std::string&, const std::string& topic, int out) {
  auto node = bridge::DdsNode::create({.domain = domain_of_environment(), .node = "latency"});
  if (!node.ok()) return 1;
  static std::atomic<bool> is_over{false};
  // Leaves as programs do: a killed one counts as a subscriber for 20 s more.
  std::signal(SIGTERM, [](int) { is_over = true; });
  const auto reader = (*node)->add_reader(
      {.topic = bridge::dds_topic(topic),
       .type = bridge::dds_type(type_of(topic)),
       .qos = {.is_reliable = false, .depth = 100}},
      [out](const bridge::DdsSample& sample) {
        if (!tell(out, {first_stamp(sample.data), now_ms(), sample.data.size()})) is_over = true;
      });
  if (!reader.ok()) return 1;
  while (!is_over) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return 0;
}

int run_rclpy_client(const std::string&, const std::string& topic, int out) {
  const char* python = std::getenv("GLOAM_RCLPY");  // an interpreter that has it
  if (python == nullptr) return 1;
  const std::string number = std::to_string(out), type = type_of(topic);
  execlp(python, python, "bench/latency/rclpy_client.py", topic.c_str(), type.c_str(),
         number.c_str(), nullptr);
  return 1;
}

}  // namespace gloam::latency

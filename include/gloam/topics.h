#pragma once
// Topics: what a simulation says and hears as ROS 2 messages, one table for logs and bridges. Names
// and types follow REP 103, 105 and 145 and what ROS drivers do; docs/topics.md lists the rules.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/stream.h"
#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam {

/// ROS 2's quality of service, as publishers offer it.
struct TopicQos {
  bool is_reliable = true;  ///< else best effort
  bool is_latched = false;  ///< transient local: late subscribers get the last message
  int depth = 10;           ///< keep last
};

struct TopicInfo {
  std::string name;        ///< "/front/image_raw"
  std::string type;        ///< "sensor_msgs/msg/Image"
  std::string frame_id;    ///< of its header; "" where it has none
  Rational rate = {0, 1};  ///< messages per second of simulation time [Hz]; 0 = every step
  TopicQos qos = {};
  bool is_input = false;    ///< heard: Simulation::publish
  bool is_logged = true;    ///< in a log that names no topics
  std::string source = {};  ///< what it tells of: "camera front", "robot go1"
};

/// The type of a message, for whoever declares a topic.
struct MessageInfo {
  std::string dds_name;    ///< "sensor_msgs::msg::dds_::Image_"
  std::string definition;  ///< ros2msg, with the definitions of its parts
  std::string hash;        ///< "RIHS01_…", REP 2016
};
/// Error: Gloam has no message of this name.
Result<MessageInfo> message_info(std::string_view type);

/// Topics of a World. Error: a [[topic]] of its scene that fits none.
Result<std::vector<TopicInfo>> list_topics(const World& world);

/// Topics of elements that do not have the names of the rules, since these were taken.
std::vector<Error> topic_notes(const World& world);

/// One message. What it refers to lives as long as the callback.
struct TopicMessage {
  const TopicInfo& topic;
  int64_t run = -1;               ///< resets before it; -1 = its sensor does not tell
  int64_t step = 0;               ///< physics step of its data
  double time = 0;                ///< simulation time of its stamp [s]
  double delivery = 0;            ///< when it reaches a reader [s], >= time
  std::span<const uint8_t> data;  ///< CDR, little endian, with its head of four bytes
};
/// Comes on threads of the streams, for one topic on one thread at a time; those that are latched
/// come first, before open_topics returns.
using TopicCallback = std::function<void(const TopicMessage&)>;

struct TopicRequest {
  std::vector<std::string> topics;  ///< names; * stands for any text
  int width = 0, height = 0;        ///< of every camera's pictures [px]; 0 = the camera's own
  bool required = false;  ///< the simulation waits for its reader; else messages are lost, counted
  /// A message whenever a topic that adds up over time looks at the simulation (/metrics: at
  /// record.metrics_rate) instead of at the topic's rate.
  bool every_sample = false;
  EndCallback on_end = {};
};

/// Closing it waits for its last callbacks.
class TopicStream : public Stream {};

}  // namespace gloam

#pragma once
// Topics: ROS 2 messages that a simulation publishes and accepts, in one table for logs and
// bridges. Names and types follow REP 103, 105 and 145 and common ROS drivers; docs/topics.md lists
// the rules.

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

/// ROS 2 quality of service offered by publishers.
struct TopicQos {
  bool is_reliable = true;  ///< else best effort
  bool is_latched = false;  ///< transient local: late subscribers receive the last message
  int depth = 10;           ///< keep last
};

struct TopicInfo {
  std::string name;        ///< "/front/image_raw"
  std::string type;        ///< "sensor_msgs/msg/Image"
  std::string frame_id;    ///< of the header; "" if the type has none
  Rational rate = {0, 1};  ///< messages per second of simulation time [Hz]; 0 = every step
  TopicQos qos = {};
  bool is_input = false;    ///< accepted by Simulation::publish
  bool is_logged = true;    ///< recorded by logs that do not name topics
  std::string source = {};  ///< element that it describes: "camera front", "robot go1"
};

/// The type of a message, for declaring topics.
struct MessageInfo {
  std::string dds_name;    ///< "sensor_msgs::msg::dds_::Image_"
  std::string definition;  ///< ros2msg, with the definitions of nested types
  std::string hash;        ///< "RIHS01_…", REP 2016
};
/// Error: Gloam has no message of this name.
Result<MessageInfo> message_info(std::string_view type);

/// Topics of a World. Error: a [[topic]] of its scene that matches none.
Result<std::vector<TopicInfo>> list_topics(const World& world);

/// Topics that deviate from the naming rules because the regular name was taken.
std::vector<Error> topic_notes(const World& world);

/// One message. Its references are valid during the callback.
struct TopicMessage {
  const TopicInfo& topic;
  int64_t run = -1;               ///< number of resets before it; -1 = unknown to its sensor
  int64_t step = 0;               ///< physics step of the data
  double time = 0;                ///< simulation time of its stamp [s]
  double delivery = 0;            ///< time at which it reaches readers [s], >= time
  std::span<const uint8_t> data;  ///< CDR, little endian, with its header of four bytes
};
/// Called on threads of the streams, for one topic on one thread at a time. Latched messages come
/// first, before open_topics returns.
using TopicCallback = std::function<void(const TopicMessage&)>;

struct TopicRequest {
  std::vector<std::string> topics;  ///< names; * matches any text
  int width = 0, height = 0;        ///< of every camera's images [px]; 0 = the camera's own
  bool required = false;  ///< true: the simulation waits for the reader; false: messages may be
                          ///< lost, and are counted
  /// Sends a message for every sample of topics that accumulate values over time (/metrics: at
  /// record.metrics_rate) instead of at the topic's rate.
  bool every_sample = false;
  EndCallback on_end = {};
};

/// Closing the stream waits for its last callbacks.
class TopicStream : public Stream {};

}  // namespace gloam

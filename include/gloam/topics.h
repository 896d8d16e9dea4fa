#pragma once
// Topics: ROS 2 messages that a simulation publishes and accepts, in one table for logs and
// bridges. Names and types follow REP 103, 105 and 145 and common ROS drivers; docs/topics.md lists
// the rules.

#include <compare>
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

/// The element of a World that a topic describes. Topics of one element share a stream.
struct TopicSource {
  enum class Kind : uint8_t { kSimulation, kRobot, kCamera, kLidar, kSensor, kGas, kBody };
  Kind kind = Kind::kSimulation;
  std::string name = {};  ///< of the element; of the simulation: its part, such as "contacts"
  auto operator<=>(const TopicSource&) const = default;
};
/// "camera", "body".
const char* to_string(TopicSource::Kind kind);
/// "camera front", "mocap body hand"; the simulation's parts are their name alone.
std::string to_string(const TopicSource& source);

struct TopicInfo {
  std::string name;        ///< "/front/image_raw"
  std::string type;        ///< "sensor_msgs/msg/Image"
  std::string frame_id;    ///< of the header; "" if the type has none
  Rational rate = {0, 1};  ///< messages per second of simulation time [Hz]; 0 = every step
  TopicQos qos = {};
  bool is_input = false;  ///< accepted by Simulation::publish
  bool is_logged = true;  ///< recorded by logs that do not name topics
  TopicSource source = {};
  bool is_large = false;  ///< messages of kilobytes to megabytes, such as images and point clouds
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
class TopicStream : public Stream {
 public:
  /// Replaces the topics. Streams of topics that stay go on: a camera that gains or loses topics is
  /// not reopened. One call at a time. Errors: as Simulation::open_topics.
  virtual Status set_topics(std::span<const std::string> names) = 0;
};

/// A reader that shares streams with other readers, such as a bridge.
class TopicSink {
 public:
  virtual ~TopicSink() = default;
  /// A message of a topic that it has subscribed to. On threads of the streams, for one topic on
  /// one thread at a time; must not block.
  virtual void on_message(const TopicMessage& message) = 0;
  /// All topics, inputs too: before Simulation::subscribe returns, and after each recompile on a
  /// thread of the hub.
  virtual void on_topics(std::span<const TopicInfo> topics) = 0;
  /// A topic that it has subscribed to does not exist, cannot be opened or has ended. The hub tries
  /// again every second, and reports each cause once. On a thread of the hub.
  virtual void on_error(const std::string& topic, const Error& why) = 0;
};

/// Ending the subscription waits for the last callback of its sink, so a callback must not end it.
class TopicSubscription {
 public:
  virtual ~TopicSubscription() = default;
  /// Replaces the topics, by their names. It returns at once: the hub's thread opens the streams,
  /// and keeps a stream for two seconds after its last reader has gone. Any thread.
  virtual void set_topics(std::vector<std::string> names) = 0;
  /// For another reader behind the sink: visits the last message of a latched topic if there is
  /// one, and reports the error of a topic again. Any thread.
  virtual void repeat(const std::string& topic, const TopicCallback& visit) = 0;
  /// Messages that the streams of its topics have lost.
  virtual int64_t dropped() const = 0;
};

}  // namespace gloam

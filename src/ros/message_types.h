#pragma once
// The names, definition and hash of a message's type, which logs and bridges declare beside topics.

#include <span>
#include <string>
#include <string_view>

#include "ros/type_description.h"

namespace gloam {

struct MessageType {
  std::string name;      ///< "sensor_msgs/msg/Imu"
  std::string dds_name;  ///< "sensor_msgs::msg::dds_::Imu_"
  std::string text;      ///< ros2msg, with the definitions of its parts; empty for an empty message
  std::string hash;      ///< "RIHS01_…"
};

MessageType make_message_type(const TypeDescription& type);

/// The type of a struct; made when it is first asked for.
template <Message T>
const MessageType& message_type() {
  static const MessageType type = make_message_type(describe<T>());
  return type;
}

/// The types of all messages in definitions/, without older versions.
std::span<const MessageType> message_types();

/// The type named "sensor_msgs/msg/Imu"; nullptr if Gloam does not know it.
const MessageType* find_message_type(std::string_view name);

/// The hash of a service, of "std_srvs/srv/Trigger" for example, out of its request and response.
/// ROS nodes declare it for both of a service's endpoints.
std::string service_hash(std::string_view name, const TypeDescription& request,
                         const TypeDescription& response);

}  // namespace gloam

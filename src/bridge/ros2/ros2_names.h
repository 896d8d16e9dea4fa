#pragma once
// ROS 2's names on the wire of DDS, as rmw_fastrtps and rmw_cyclonedds write them (REP-2003's
// neighbours in design.ros2.org, "Topic and Service name mapping to DDS").

#include <string>
#include <string_view>

namespace gloam::bridge {

/// "/cam/image" -> "rt/cam/image".
std::string dds_topic(std::string_view topic);
/// "/step" -> "rq/stepRequest" and "rr/stepReply".
std::string dds_request(std::string_view service);
std::string dds_reply(std::string_view service);
/// "std_msgs/msg/String" -> "std_msgs::msg::dds_::String_"; of services and actions the same with a
/// suffix: ("std_srvs/srv/Empty", "_Request") -> "std_srvs::srv::dds_::Empty_Request_".
std::string dds_type(std::string_view type, std::string_view suffix = "");
/// A text as a name of ROS: letters, digits, '_' and, between parts, '/'. "sim 1" -> "sim_1".
std::string ros_name(std::string_view text);

}  // namespace gloam::bridge

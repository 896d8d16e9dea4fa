#pragma once
// Messages of ROS 2's package diagnostic_msgs.

#include "ros/messages/std_msgs.h"

namespace gloam::diagnostic_msgs {

inline constexpr std::string_view kPackage = "diagnostic_msgs/msg";

struct KeyValue {
  std::string key, value;
  GLOAM_MESSAGE(KeyValue, key, value)
};

struct DiagnosticStatus {
  std::byte level = {};  ///< std::byte{DiagnosticStatus::WARN}
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
  GLOAM_CONSTANTS(byte, OK = 0, WARN = 1, ERROR = 2, STALE = 3)
  GLOAM_MESSAGE(DiagnosticStatus, level, name, message, hardware_id, values)
};

struct DiagnosticArray {
  std_msgs::Header header;
  std::vector<DiagnosticStatus> status;
  GLOAM_MESSAGE(DiagnosticArray, header, status)
};

}  // namespace gloam::diagnostic_msgs

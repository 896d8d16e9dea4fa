#pragma once
// Messages of ROS 2's package unique_identifier_msgs.

#include "ros/message.h"

namespace gloam::unique_identifier_msgs {

inline constexpr std::string_view kPackage = "unique_identifier_msgs/msg";

struct UUID {
  std::array<uint8_t, 16> uuid = {};
  GLOAM_MESSAGE(UUID, uuid)
};

}  // namespace gloam::unique_identifier_msgs

#pragma once
// Messages of ROS 2's package builtin_interfaces.

#include "ros/message.h"

namespace gloam::builtin_interfaces {

inline constexpr std::string_view kPackage = "builtin_interfaces/msg";

struct Time {
  int32_t sec = 0;
  uint32_t nanosec = 0;  ///< [0, 1e9)
  GLOAM_MESSAGE(Time, sec, nanosec)
};

/// Like Time: the sum of both, so -0.5 s is {-1, 500000000}.
struct Duration {
  int32_t sec = 0;
  uint32_t nanosec = 0;  ///< [0, 1e9)
  GLOAM_MESSAGE(Duration, sec, nanosec)
};

}  // namespace gloam::builtin_interfaces

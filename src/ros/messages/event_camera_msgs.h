#pragma once
// Messages of the package event_camera_msgs.

#include "ros/messages/std_msgs.h"

namespace gloam::event_camera_msgs {

inline constexpr std::string_view kPackage = "event_camera_msgs/msg";

struct EventPacket {
  std_msgs::Header header;
  uint32_t height = 0, width = 0;
  uint64_t seq = 0;
  uint64_t time_base = 0;  ///< added to the times in `events`, where the encoding has need of it
  std::string encoding;    ///< "evt3", "mono", …
  bool is_bigendian = false;
  Bytes events;
  GLOAM_MESSAGE(EventPacket, header, height, width, seq, time_base, encoding, is_bigendian, events)
};

}  // namespace gloam::event_camera_msgs

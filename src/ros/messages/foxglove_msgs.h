#pragma once
// Messages of Foxglove's package foxglove_msgs.

#include "ros/messages/builtin_interfaces.h"

namespace gloam::foxglove_msgs {

inline constexpr std::string_view kPackage = "foxglove_msgs/msg";

/// One frame of a video.
struct CompressedVideo {
  builtin_interfaces::Time timestamp;
  std::string frame_id;
  Bytes data;          ///< h264: Annex B, one picture, SPS and PPS with every key frame
  std::string format;  ///< "h264", "h265", "vp9", "av1"
  GLOAM_MESSAGE(CompressedVideo, timestamp, frame_id, data, format)
};

}  // namespace gloam::foxglove_msgs

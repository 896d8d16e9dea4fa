#pragma once
// Messages of ROS 2's package vision_msgs.

#include "ros/messages/std_msgs.h"

namespace gloam::vision_msgs {

inline constexpr std::string_view kPackage = "vision_msgs/msg";

struct VisionClass {
  uint16_t class_id = 0;
  std::string class_name;
  GLOAM_MESSAGE(VisionClass, class_id, class_name)
};

/// Names of the ids in a picture.
struct LabelInfo {
  std_msgs::Header header;
  std::vector<VisionClass> class_map;
  float threshold = 0;  ///< of a mask's confidence
  GLOAM_MESSAGE(LabelInfo, header, class_map, threshold)
};

}  // namespace gloam::vision_msgs

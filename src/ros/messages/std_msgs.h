#pragma once
// Messages of ROS 2's package std_msgs.

#include "ros/messages/builtin_interfaces.h"

namespace gloam::std_msgs {

inline constexpr std::string_view kPackage = "std_msgs/msg";

struct Header {
  builtin_interfaces::Time stamp;  ///< simulation time
  std::string frame_id;
  GLOAM_MESSAGE(Header, stamp, frame_id)
};

struct String {
  std::string data;
  GLOAM_MESSAGE(String, data)
};

struct Bool {
  bool data = false;
  GLOAM_MESSAGE(Bool, data)
};

struct Empty {
  GLOAM_MESSAGE(Empty)
};

struct Float64 {
  double data = 0;
  GLOAM_MESSAGE(Float64, data)
};

struct MultiArrayDimension {
  std::string label;
  uint32_t size = 0, stride = 0;
  GLOAM_MESSAGE(MultiArrayDimension, label, size, stride)
};

struct MultiArrayLayout {
  std::vector<MultiArrayDimension> dim;  ///< outermost first
  uint32_t data_offset = 0;
  GLOAM_MESSAGE(MultiArrayLayout, dim, data_offset)
};

struct Float64MultiArray {
  MultiArrayLayout layout;
  std::vector<double> data;
  GLOAM_MESSAGE(Float64MultiArray, layout, data)
};

struct ColorRGBA {
  float r = 0, g = 0, b = 0, a = 0;  ///< [0, 1]
  GLOAM_MESSAGE(ColorRGBA, r, g, b, a)
};

}  // namespace gloam::std_msgs

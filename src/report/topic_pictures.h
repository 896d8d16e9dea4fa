#pragma once
// Pictures of image topics of any writer's log.

#include <cstdint>
#include <vector>

#include "geometry/image/image.h"
#include "gloam/result.h"
#include "ros/dynamic_message.h"

namespace gloam {

/// One message: colours or grey, or a depth.
struct TopicPicture {
  int64_t stamp = 0;  ///< [ns]
  Image8 image;       ///< 1 or 3 channels; empty of a depth
  int width = 0, height = 0;
  std::vector<float> depth;  ///< [m], (height x width); +inf = nothing

  bool is_depth() const { return !depth.empty(); }
};

/// sensor_msgs/Image: rgb8, bgr8, rgba8, bgra8, mono8, 8UC1, 32FC1 [m], 16UC1 [mm];
/// CompressedImage: JPEG or PNG. Errors: another encoding, sizes that do not fit the data.
Result<TopicPicture> topic_picture(const DynamicMessage& message, bool is_compressed);

}  // namespace gloam

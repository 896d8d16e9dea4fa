#include "topics/topic_video.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "render/film/h264.h"
#include "ros/messages/foxglove_msgs.h"
#include "topics/ros_values.h"

namespace gloam {
namespace {

constexpr int kVideoQp = 20;            // H.264 quantiser: about 42 dB
constexpr double kMostKeyAge = 1;       // simulation time between key pictures [s]
constexpr double kTimeRounding = 1e-6;  // [s]

class H264Topic {
 public:
  Status encode_frame(const TopicInfo& topic, const CameraFrame& frame, MessageBytes* out) {
    rgb_to_yuv420(frame.intrinsics.width, frame.intrinsics.height, frame.rgb, &yuv_);
    if (encoder_ == nullptr) {
      const Rational rate = topic.rate.num > 0 ? topic.rate : Rational{20, 1};
      GLOAM_TRY(encoder_, H264Encoder::create(yuv_.width, yuv_.height, rate, 0, kVideoQp));
    }
    // The next picture may come a period later: a key picture comes before its second is over.
    const double next = frame.time + std::max(0.0, frame.time - last_time_);
    const bool is_reset = frame.time < last_time_;
    if (is_reset || next > last_key_ + kMostKeyAge + kTimeRounding) encoder_->request_key();
    last_time_ = frame.time;
    GLOAM_TRY(const H264Picture picture, encoder_->encode(yuv_));
    if (picture.key) last_key_ = frame.time;
    const std::vector<uint8_t> bytes = annex_b(*encoder_, picture);
    encode(foxglove_msgs::CompressedVideo{ros_time(frame.time), topic.frame_id, Bytes::view(bytes),
                                          "h264"},
           out);
    return {};
  }

 private:
  std::unique_ptr<H264Encoder> encoder_;
  Yuv420 yuv_;
  double last_key_ = -std::numeric_limits<double>::infinity();
  double last_time_ = 0;  // of the last picture [s]
};

}  // namespace

FrameEncoder h264_encoder() {
  return [video = std::make_shared<H264Topic>()](const TopicInfo& topic, const CameraFrame& frame,
                                                 MessageBytes* out) {
    return video->encode_frame(topic, frame, out);
  };
}

}  // namespace gloam

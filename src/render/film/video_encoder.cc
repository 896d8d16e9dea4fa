#include <algorithm>
#include <cmath>
#include <utility>

#include "gloam/view.h"
#include "render/film/h264.h"

namespace gloam {
namespace {

constexpr int kQp = 22;  // quantiser: no visible blocks in smooth walls

class H264VideoEncoder final : public VideoEncoder {
 public:
  H264VideoEncoder(std::unique_ptr<H264Encoder> encoder, int width, int height)
      : encoder_(std::move(encoder)), width_(width), height_(height) {}

  Result<Packet> encode(std::span<const uint8_t> rgb, bool key) override {
    if (rgb.size() != 3 * static_cast<size_t>(width_) * static_cast<size_t>(height_))
      return Error{ErrorKind::kInput, "the image has no colour, or another size than the video"};
    rgb_to_yuv420(width_, height_, rgb, &yuv_);
    if (key) encoder_->request_key();
    GLOAM_TRY(const H264Picture picture, encoder_->encode(yuv_));
    return Packet{annex_b(*encoder_, picture), picture.key};
  }

 private:
  std::unique_ptr<H264Encoder> encoder_;
  int width_, height_;
  Yuv420 yuv_;
};

}  // namespace

Result<std::unique_ptr<VideoEncoder>> VideoEncoder::create(int width, int height, double rate) {
  const Rational frames{std::llround(1000 * std::clamp(rate, 1.0, 60.0)), 1000};
  GLOAM_TRY(auto encoder,
            H264Encoder::create(width + width % 2, height + height % 2, frames, 0, kQp));
  return std::unique_ptr<VideoEncoder>(
      std::make_unique<H264VideoEncoder>(std::move(encoder), width, height));
}

}  // namespace gloam

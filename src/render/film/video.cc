#include "render/film/video.h"

#include <algorithm>
#include <cmath>

namespace gloam {

Result<VideoWriter> VideoWriter::start(std::unique_ptr<ByteSink> sink,
                                       const VideoOptions& options) {
  const int width = (options.width + 1) & ~1, height = (options.height + 1) & ~1;
  // A key picture about every second: players seek to those.
  const int interval = static_cast<int>(std::clamp(std::round(options.rate.value()), 1.0, 240.0));
  GLOAM_TRY(std::unique_ptr<H264Encoder> encoder,
            H264Encoder::create(width, height, options.rate, interval, options.qp));
  return VideoWriter(std::move(sink), options, std::move(encoder));
}

Status VideoWriter::add(int64_t index, std::span<const uint8_t> rgb) {
  rgb_to_yuv420(options_.width, options_.height, rgb, &yuv_);
  GLOAM_TRY(const H264Picture picture, encoder_->encode(yuv_));
  if (!mp4_) {
    GLOAM_TRY(Mp4Writer writer,
              Mp4Writer::start(std::move(sink_), {yuv_.width, yuv_.height, options_.rate,
                                                  encoder_->sps(), encoder_->pps()}));
    mp4_ = std::move(writer);
  }
  return mp4_->add(index, picture.key, picture.bytes);
}

Status VideoWriter::finish() {
  if (mp4_) return mp4_->finish();
  return sink_ ? sink_->close() : Status();  // no sink: the header could not be written
}

}  // namespace gloam

#pragma once
// A camera's pictures as an H.264 video in an MP4 file.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "gloam/result.h"
#include "gloam/types.h"
#include "render/film/byte_sink.h"
#include "render/film/h264.h"
#include "render/film/mp4.h"

namespace gloam {

struct VideoOptions {
  int width = 640, height = 480;  ///< [px]; odd sizes are extended by one repeated line
  Rational rate = {20, 1};        ///< pictures per second of simulation time
  int qp = 18;  ///< H.264 quantiser, 0 (best) … 51; 18 is visually clean (44-45 dB)
};

/// BT.709, limited range, 4:2:0. The file is playable at every moment and survives kill -9.
class VideoWriter {
 public:
  /// Errors: a size that H.264 cannot hold. The file's header follows with the first picture.
  static Result<VideoWriter> start(std::unique_ptr<ByteSink> sink, const VideoOptions& options);
  /// `rgb`: sRGB (height x width x 3). `index` counts pictures at `rate` and rises strictly; where
  /// indices are missing the picture before stays on. After an error only finish() may be called.
  Status add(int64_t index, std::span<const uint8_t> rgb);
  Status finish();

 private:
  VideoWriter(std::unique_ptr<ByteSink> sink, const VideoOptions& options,
              std::unique_ptr<H264Encoder> encoder)
      : sink_(std::move(sink)), options_(options), encoder_(std::move(encoder)) {}

  std::unique_ptr<ByteSink> sink_;  // handed to mp4_ with the first picture
  VideoOptions options_;
  std::unique_ptr<H264Encoder> encoder_;
  std::optional<Mp4Writer> mp4_;
  Yuv420 yuv_;
};

}  // namespace gloam

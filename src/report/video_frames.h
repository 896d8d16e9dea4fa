#pragma once
// Pictures out of the videos of results folders: MP4 with one H.264 track, as VideoWriter makes
// them, finished or cut.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/image/image.h"
#include "gloam/result.h"

namespace gloam {

/// Index of a video.
struct VideoIndex {
  struct Sample {
    uint64_t offset = 0;
    uint32_t size = 0;
    double time = 0;  ///< from the first picture [s]
    bool key = false;
  };
  std::vector<uint8_t> sps, pps;  ///< without start codes
  std::vector<Sample> samples;
};
/// Errors: no MP4, none of these tracks, samples beyond the end of the file.
Result<VideoIndex> index_video(std::span<const uint8_t> file, const std::string& name);

class VideoReader {
 public:
  static Result<VideoReader> open(const std::filesystem::path& file);
  const VideoIndex& index() const { return index_; }
  /// Picture of a sample, 8-bit sRGB (BT.709, limited range). Errors: it cannot be decoded.
  Result<Image8> decode(size_t sample) const;

 private:
  std::string name_;
  std::vector<uint8_t> bytes_;
  VideoIndex index_;
};

}  // namespace gloam

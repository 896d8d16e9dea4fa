#pragma once
// MP4 with one H.264 track (ISO/IEC 14496-12 and -15). While it grows it is a fragmented file: one
// fragment per picture, so whatever was written stays playable after a crash or on a full disk.
// finish() adds the index of an ordinary MP4 over the same bytes, so players can seek.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "render/film/byte_sink.h"

namespace gloam {

struct Mp4Track {
  int width = 0, height = 0;      ///< [px]
  Rational rate = {20, 1};        ///< pictures per second; one picture lasts exactly 1 / rate
  std::vector<uint8_t> sps, pps;  ///< without start codes
};

/// A picture in the file.
struct Mp4Sample {
  uint64_t offset;  ///< [bytes]
  uint32_t size;    ///< [bytes]
  int64_t index;    ///< on the grid of the track's rate
  bool key;
};

class Mp4Writer {
 public:
  /// Writes the header.
  static Result<Mp4Writer> start(std::unique_ptr<ByteSink> sink, const Mp4Track& track);
  /// Adds a picture shown from `index` / rate seconds on, until the next one. `index` rises
  /// strictly. `sample`: NAL units after their lengths. After an error nothing may be added.
  Status add(int64_t index, bool key, std::span<const uint8_t> sample);
  Status finish();

 private:
  Mp4Writer(std::unique_ptr<ByteSink> sink, Mp4Track track)
      : sink_(std::move(sink)), track_(std::move(track)) {}
  Status append(std::span<const uint8_t> bytes);
  std::vector<uint8_t> movie_header(bool indexed) const;

  std::unique_ptr<ByteSink> sink_;
  Mp4Track track_;
  uint64_t end_ = 0;        // [bytes] written
  uint64_t free_box_ = 0;   // offset of the box that becomes the header of the media data
  uint32_t timescale_ = 1;  // [1/s]
  uint32_t duration_ = 1;   // of one picture [1/timescale]
  std::vector<Mp4Sample> samples_;
};

}  // namespace gloam

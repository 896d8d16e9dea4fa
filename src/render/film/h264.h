#pragma once
// H.264 by OpenH264: constant quality, no frame reordering, one thread, so the bytes are a function
// of the pictures.

#include <cstdint>
#include <memory>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "render/film/yuv.h"

namespace gloam {

/// One coded picture.
struct H264Picture {
  std::vector<uint8_t> bytes;  ///< NAL units, each after its length in 4 bytes, big-endian
  bool key = false;            ///< decodable without others
};

/// Largest picture that OpenH264 codes (level 5.2) [px].
inline constexpr int kMaxVideoPixels = 36864 * 256;

class H264Encoder {
 public:
  virtual ~H264Encoder() = default;
  /// `key_interval` = frames from one key picture to the next, 0 = only the first and those that
  /// are requested; `qp` = quantiser, 0 (best) to 51.
  /// Errors: size below 16 x 16 or above kMaxVideoPixels, odd size.
  static Result<std::unique_ptr<H264Encoder>> create(int width, int height, Rational rate,
                                                     int key_interval, int qp);
  virtual Result<H264Picture> encode(const Yuv420& picture) = 0;
  /// The next picture becomes a key picture.
  virtual void request_key() = 0;
  /// Sequence and picture parameter sets, without start codes; known after the first picture.
  virtual const std::vector<uint8_t>& sps() const = 0;
  virtual const std::vector<uint8_t>& pps() const = 0;
};

/// The picture as a byte stream (ISO/IEC 14496-10, Annex B): a start code before each NAL unit, the
/// parameter sets before a key picture.
std::vector<uint8_t> annex_b(const H264Encoder& encoder, const H264Picture& picture);

}  // namespace gloam

#pragma once
// Pictures on their way to the page: a JPEG or a packet of H.264 behind a fixed header,
// docs/view_protocol.md.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gloam/camera.h"
#include "gloam/result.h"

namespace gloam::studio {

inline constexpr size_t kPictureHeaderSize = 152;

enum class Codec : uint8_t { kJpeg, kH264 };

/// A frame that came from the renderer. `sequence` counts them, so that gaps tell a client about
/// frames that it has not been sent; `camera` is a row of the hello message's list.
struct RenderedFrame {
  std::shared_ptr<const CameraFrame> frame;
  uint64_t sequence = 0;
  uint32_t camera = 0;
};

/// Header and coded image. `is_key`: of H.264, whether it is decodable without earlier packets.
std::vector<uint8_t> make_packet(const RenderedFrame& rendered, Codec codec, bool is_key,
                                 std::span<const uint8_t> coded);
/// The frame as a packet with a JPEG.
Result<std::vector<uint8_t>> jpeg_packet(const RenderedFrame& rendered);

}  // namespace gloam::studio

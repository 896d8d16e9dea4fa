#include "studio/picture.h"

#include <bit>
#include <cstring>
#include <string_view>

#include "gloam/view.h"

namespace gloam::studio {
namespace {

template <class T>
void append(std::vector<uint8_t>& bytes, T value) {
  static_assert(std::endian::native == std::endian::little, "the header is little-endian");
  const size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(&bytes[end], &value, sizeof value);
}

}  // namespace

std::vector<uint8_t> make_packet(const RenderedFrame& rendered, Codec codec, bool is_key,
                                 std::span<const uint8_t> coded) {
  const CameraFrame& frame = *rendered.frame;
  const Intrinsics& k = frame.intrinsics;
  const uint32_t flags =
      (k.orthographic ? 1u : 0u) | (codec == Codec::kH264 ? 2u : 0u) | (is_key ? 4u : 0u);
  std::vector<uint8_t> packet;
  packet.reserve(kPictureHeaderSize + coded.size());
  for (const char letter : std::string_view("GLV1")) append(packet, letter);
  append<uint32_t>(packet, kPictureHeaderSize);
  append<uint64_t>(packet, rendered.sequence);
  append<int64_t>(packet, frame.index);
  append<double>(packet, frame.time);
  append<uint16_t>(packet, static_cast<uint16_t>(k.width));
  append<uint16_t>(packet, static_cast<uint16_t>(k.height));
  append<uint32_t>(packet, rendered.camera);
  append<uint32_t>(packet, flags);
  for (const double value : {k.fx, k.fy, k.cx, k.cy})
    append<float>(packet, static_cast<float>(value));
  const Pose& X = frame.X_WC;
  for (const double value : {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z})
    append(packet, value);
  append<uint32_t>(packet, static_cast<uint32_t>(k.lens));
  for (const double value : k.distortion) append<float>(packet, static_cast<float>(value));
  packet.insert(packet.end(), coded.begin(), coded.end());
  return packet;
}

Result<std::vector<uint8_t>> jpeg_packet(const RenderedFrame& rendered) {
  const Intrinsics& k = rendered.frame->intrinsics;
  GLOAM_TRY(const std::vector<uint8_t> jpeg, encode_jpeg(k.width, k.height, rendered.frame->rgb));
  return make_packet(rendered, Codec::kJpeg, true, jpeg);
}

}  // namespace gloam::studio

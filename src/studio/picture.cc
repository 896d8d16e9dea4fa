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

Result<std::vector<uint8_t>> encode_picture(const CameraFrame& frame, uint64_t sequence,
                                            uint32_t camera) {
  const Intrinsics& k = frame.intrinsics;
  GLOAM_TRY(const std::vector<uint8_t> jpeg, encode_jpeg(k.width, k.height, frame.rgb));
  std::vector<uint8_t> packet;
  packet.reserve(kPictureHeaderSize + jpeg.size());
  for (const char letter : std::string_view("GLV1")) append(packet, letter);
  append<uint32_t>(packet, kPictureHeaderSize);
  append<uint64_t>(packet, sequence);
  append<int64_t>(packet, frame.index);
  append<double>(packet, frame.time);
  append<uint16_t>(packet, static_cast<uint16_t>(k.width));
  append<uint16_t>(packet, static_cast<uint16_t>(k.height));
  append<uint32_t>(packet, camera);
  append<uint32_t>(packet, k.orthographic ? 1 : 0);
  for (const double value : {k.fx, k.fy, k.cx, k.cy})
    append<float>(packet, static_cast<float>(value));
  const Pose& X = frame.X_WC;
  for (const double value : {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z})
    append(packet, value);
  append<uint32_t>(packet, static_cast<uint32_t>(k.lens));
  for (const double value : k.distortion) append<float>(packet, static_cast<float>(value));
  packet.insert(packet.end(), jpeg.begin(), jpeg.end());
  return packet;
}

}  // namespace gloam::studio

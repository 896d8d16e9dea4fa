#include "studio/picture.h"

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
// jpeglib.h needs FILE and size_t declared before it.
#include <jpeglib.h>

namespace gloam::studio {
namespace {

constexpr int kQuality = 88;
constexpr int kMaxSide = 65500;  // JPEG_MAX_DIMENSION of libjpeg

/// libjpeg reports failures by a call that must not return.
struct JumpingErrors {
  jpeg_error_mgr base;
  jmp_buf recovery;
};

void jump_out(j_common_ptr info) {
  longjmp(reinterpret_cast<JumpingErrors*>(info->err)->recovery, 1);
}
void say_nothing(j_common_ptr) {}

/// Only plain C values live here, so that the jump skips no destructor. False: out of memory.
bool compress(const uint8_t* rgb, int width, int height, unsigned char** bytes,
              unsigned long* size) {
  jpeg_compress_struct info;
  JumpingErrors errors;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = jump_out;
  errors.base.output_message = say_nothing;
  if (setjmp(errors.recovery) != 0) {
    jpeg_destroy_compress(&info);
    return false;
  }
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, bytes, size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, kQuality, TRUE);
  info.dct_method = JDCT_ISLOW;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const size_t offset = size_t{3} * info.next_scanline * info.image_width;
    JSAMPROW row = const_cast<JSAMPROW>(rgb + offset);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

template <class T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little, "the header is little-endian");
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace

Result<std::string> encode_jpeg(const std::vector<uint8_t>& rgb, int width, int height) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide ||
      rgb.size() != size_t{3} * static_cast<size_t>(width) * static_cast<size_t>(height)) {
    return Error{
        .kind = ErrorKind::kInput,
        .message = "the picture has no colours, or its size is not one that JPEG can hold"};
  }
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool done = compress(rgb.data(), width, height, &bytes, &size);
  std::string jpeg;
  if (done) jpeg.assign(reinterpret_cast<const char*>(bytes), size);
  std::free(bytes);
  if (!done)
    return Error{.kind = ErrorKind::kIo, .message = "there is no memory to compress the picture"};
  return jpeg;
}

Result<std::string> encode_picture(const CameraFrame& frame, uint64_t sequence, uint32_t camera) {
  const Intrinsics& k = frame.intrinsics;
  GLOAM_TRY(const std::string jpeg, encode_jpeg(frame.rgb, k.width, k.height));
  std::string packet;
  packet.reserve(kPictureHeaderSize + jpeg.size());
  packet.append("GLV1", 4);
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
  packet.append(kPictureHeaderSize - packet.size(), '\0');
  packet += jpeg;
  return packet;
}

}  // namespace gloam::studio

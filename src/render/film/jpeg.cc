#include <csetjmp>
#include <cstdio>
#include <cstdlib>
// jpeglib.h needs FILE and size_t declared before it.
#include <jpeglib.h>

#include "base/check.h"
#include "gloam/view.h"

namespace gloam {
namespace {

struct ErrorManager {
  jpeg_error_mgr base;
  jmp_buf recovery;
};
void jump_out(j_common_ptr info) {
  std::longjmp(reinterpret_cast<ErrorManager*>(info->err)->recovery, 1);
}
void stay_silent(j_common_ptr) {}

// Only trivial objects live in this frame: libjpeg leaves it with longjmp when it fails.
bool write_jpeg(int width, int height, const uint8_t* rgb, int quality, uint8_t** bytes,
                unsigned long* size) {
  jpeg_compress_struct info;
  ErrorManager errors;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = jump_out;
  errors.base.output_message = stay_silent;
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
  jpeg_set_quality(&info, quality, TRUE);
  info.dct_method = JDCT_ISLOW;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const size_t offset = 3 * static_cast<size_t>(info.next_scanline) * static_cast<size_t>(width);
    JSAMPROW row = const_cast<JSAMPROW>(rgb + offset);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  return true;
}

}  // namespace

Result<std::vector<uint8_t>> encode_jpeg(int width, int height, std::span<const uint8_t> rgb,
                                         int quality) {
  GLOAM_CHECK(quality >= 1 && quality <= 100, "the JPEG quality must be from 1 to 100");
  if (width < 1 || height < 1 || width > JPEG_MAX_DIMENSION || height > JPEG_MAX_DIMENSION ||
      rgb.size() != 3 * static_cast<size_t>(width) * static_cast<size_t>(height)) {
    return Error{ErrorKind::kInput,
                 "the image has no colour, or its size is not supported by JPEG"};
  }
  uint8_t* bytes = nullptr;
  unsigned long size = 0;
  const bool ok = write_jpeg(width, height, rgb.data(), quality, &bytes, &size);
  std::vector<uint8_t> out(bytes, bytes + (ok ? size : 0));
  std::free(bytes);
  if (!ok) return Error{ErrorKind::kIo, "out of memory while compressing the image"};
  return out;
}

}  // namespace gloam

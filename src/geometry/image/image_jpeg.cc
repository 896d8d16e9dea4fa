#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

#include "geometry/image/image_file.h"

namespace gloam {
namespace {

// State that libjpeg's longjmp passes over must be trivial, so everything that owns memory is here
// and in decode_jpeg.
struct JpegReader {
  jpeg_decompress_struct info = {};
  jpeg_error_mgr errors = {};
  jmp_buf recovery;
  char message[JMSG_LENGTH_MAX] = "damaged";
  bool created = false;
  ~JpegReader() {
    if (created) jpeg_destroy_decompress(&info);
  }
};

void on_jpeg_error(j_common_ptr info) {
  auto* reader = static_cast<JpegReader*>(info->client_data);
  info->err->format_message(info, reader->message);
  std::longjmp(reader->recovery, 1);
}
void on_message(j_common_ptr info, int level) {
  if (level < 0) ++info->err->num_warnings;
}

bool read_jpeg_header(JpegReader* reader, const uint8_t* bytes, size_t size) {
  reader->info.err = jpeg_std_error(&reader->errors);
  reader->errors.error_exit = on_jpeg_error;
  reader->errors.emit_message = on_message;
  reader->info.client_data = reader;
  if (setjmp(reader->recovery) != 0) return false;
  jpeg_create_decompress(&reader->info);
  reader->created = true;
  reader->info.mem->max_memory_to_use = 512L << 20;
  jpeg_mem_src(&reader->info, bytes, size);
  jpeg_read_header(&reader->info, TRUE);
  return true;
}

bool start(JpegReader* reader) {
  if (setjmp(reader->recovery) != 0) return false;
  reader->info.out_color_space =
      reader->info.jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_start_decompress(&reader->info);
  return true;
}

bool read_jpeg_rows(JpegReader* reader, uint8_t* out, size_t row) {
  if (setjmp(reader->recovery) != 0) return false;
  while (reader->info.output_scanline < reader->info.output_height) {
    JSAMPROW target = out + reader->info.output_scanline * row;
    jpeg_read_scanlines(&reader->info, &target, 1);
  }
  return true;
}

}  // namespace

Result<Image8> decode_jpeg(std::span<const uint8_t> bytes, const std::string& name,
                           uint64_t max_pixels) {
  JpegReader reader;
  const auto bad = [&name](const std::string& what) {
    return Error{
        ErrorKind::kInput, fmt::format("not a readable JPEG image: {}", what), {name, 0, 0}};
  };
  if (bytes.empty()) return bad("it is empty");
  if (!read_jpeg_header(&reader, bytes.data(), bytes.size())) return bad(reader.message);
  const uint64_t width = reader.info.image_width, height = reader.info.image_height;
  if (width * height > max_pixels)
    return bad(
        fmt::format("{} x {} is too large; the limit is {} pixels", width, height, max_pixels));
  if (reader.info.num_components != 1 && reader.info.num_components != 3)
    return bad("only grey and RGB are supported");
  if (!start(&reader)) return bad(reader.message);
  Image8 image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.channels = reader.info.output_components;
  const size_t row = width * static_cast<size_t>(image.channels);
  image.texels.resize(row * height);
  if (!read_jpeg_rows(&reader, image.texels.data(), row)) return bad(reader.message);
  // A file that ends early is filled up with grey by libjpeg and only warned about.
  if (reader.errors.num_warnings > 0) return bad("it is damaged or truncated");
  return image;
}

}  // namespace gloam

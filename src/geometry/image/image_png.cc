#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>

#include "geometry/image/image_file.h"

namespace gloam {
namespace {

struct Source {
  std::span<const uint8_t> bytes;
  size_t position = 0;
};

// State that libpng's longjmp passes over must be trivial, so everything that owns memory is here
// and in the callers.
struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  char message[128] = "damaged";
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void read_bytes(png_structp png, png_bytep out, size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (source->bytes.size() - source->position < count) png_error(png, "the file is truncated");
  std::memcpy(out, source->bytes.data() + source->position, count);
  source->position += count;
}
[[noreturn]] void on_png_error(png_structp png, png_const_charp text) {
  auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader->message, text, sizeof(reader->message) - 1);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

bool read_png_header(PngReader* reader, Source* source) {
  if (setjmp(png_jmpbuf(reader->png)) != 0) return false;
  png_set_read_fn(reader->png, source, read_bytes);
  png_set_chunk_malloc_max(reader->png, 8 << 20);
  png_set_chunk_cache_max(reader->png, 128);
  png_set_keep_unknown_chunks(reader->png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(reader->png, reader->info);
  return true;
}

bool prepare(PngReader* reader, bool wide) {
  if (setjmp(png_jmpbuf(reader->png)) != 0) return false;
  if (wide) {
    png_set_swap(reader->png);
  } else {
    png_set_scale_16(reader->png);
    png_set_expand(reader->png);  // palettes, 1-4 bit grey, transparency
  }
  png_set_interlace_handling(reader->png);
  png_read_update_info(reader->png, reader->info);
  return true;
}

bool read_png_rows(PngReader* reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader->png)) != 0) return false;
  png_read_image(reader->png, rows);
  return true;
}

template <class Texel, class Image>
Result<Image> decode(std::span<const uint8_t> bytes, const std::string& name, uint64_t max_pixels,
                     int* channels) {
  constexpr bool kIs16Bit = sizeof(Texel) == 2;
  PngReader reader;
  Source source{bytes};
  const auto bad = [&](const std::string& what) {
    return Error{
        ErrorKind::kInput, fmt::format("not a readable PNG image: {}", what), {name, 0, 0}};
  };
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_png_error, on_warning);
  if (reader.png == nullptr) return bad("out of memory");
  reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) return bad("out of memory");
  if (!read_png_header(&reader, &source)) return bad(reader.message);

  const uint64_t width = png_get_image_width(reader.png, reader.info);
  const uint64_t height = png_get_image_height(reader.png, reader.info);
  if (width * height > max_pixels)
    return bad(
        fmt::format("{} x {} is too large; the limit is {} pixels", width, height, max_pixels));
  if (kIs16Bit && (png_get_bit_depth(reader.png, reader.info) != 16 ||
                   png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY))
    return bad("expected 16-bit grey");
  if (!prepare(&reader, kIs16Bit)) return bad(reader.message);

  *channels = png_get_channels(reader.png, reader.info);
  const size_t row = png_get_rowbytes(reader.png, reader.info);
  if (row != width * static_cast<size_t>(*channels) * sizeof(Texel))
    return bad("its layout is not supported");
  Image image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.texels.resize(row / sizeof(Texel) * height);
  std::vector<png_bytep> rows(height);
  for (size_t y = 0; y < height; ++y)
    rows[y] = reinterpret_cast<png_bytep>(image.texels.data()) + y * row;
  if (!read_png_rows(&reader, rows.data())) return bad(reader.message);
  return image;
}

}  // namespace

Result<Image8> decode_png(std::span<const uint8_t> bytes, const std::string& name,
                          uint64_t max_pixels) {
  int channels = 0;
  GLOAM_TRY(Image8 image, (decode<uint8_t, Image8>(bytes, name, max_pixels, &channels)));
  image.channels = channels;
  return image;
}

Result<Image16> decode_png16(std::span<const uint8_t> bytes, const std::string& name,
                             uint64_t max_pixels) {
  int channels = 0;
  return decode<uint16_t, Image16>(bytes, name, max_pixels, &channels);
}

}  // namespace gloam

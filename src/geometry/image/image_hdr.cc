#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/image/image_file.h"
#include "geometry/mesh/text_lines.h"

namespace gloam {
namespace {

constexpr size_t kMaxHeader = 64 << 10;
constexpr int64_t kMaxHdrSide = 65536;

struct HdrHeader {
  int64_t width = 0, height = 0;
  bool upwards = false;  // the first row is the lowest
  float exposure = 1;
};

// "" or the fault. Removes the header from `bytes`.
std::string read_hdr_header(std::span<const uint8_t>* bytes, HdrHeader* out) {
  std::string_view text = as_text(bytes->first(std::min(bytes->size(), kMaxHeader)));
  const size_t all = text.size();
  if (!take_line(&text).starts_with("#?")) return "it is not an HDR file";
  for (;;) {
    if (text.empty()) return "its header is not terminated";
    const std::string_view line = trim(take_line(&text));
    if (line.empty()) break;
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      return fmt::format("its {} is not supported", line.substr(0, 60));
    float exposure = 1;
    if (line.starts_with("EXPOSURE=") && parse_number(trim(line.substr(9)), &exposure) &&
        std::isfinite(exposure) && exposure > 0)
      out->exposure *= exposure;
  }
  std::string_view size = take_line(&text);
  const std::string_view y = take_word(&size);
  if (!parse_integer(take_word(&size), &out->height) || take_word(&size) != "+X" ||
      !parse_integer(take_word(&size), &out->width) || (y != "-Y" && y != "+Y"))
    return "its size is not given as '-Y height +X width'";
  out->upwards = y == "+Y";
  if (out->width <= 0 || out->height <= 0 || out->width > kMaxHdrSide || out->height > kMaxHdrSide)
    return fmt::format("its size is {} x {}", out->width, out->height);
  *bytes = bytes->subspan(all - text.size());
  return {};
}

// The packing since 1991: each of the four bytes of a row's texels by itself.
bool read_packed_row(std::span<const uint8_t>* in, size_t width, std::vector<uint8_t>* row) {
  *in = in->subspan(4);
  for (size_t c = 0; c < 4; ++c) {
    for (size_t x = 0; x < width;) {
      if (in->size() < 2) return false;
      size_t count = (*in)[0];
      const bool is_run = count > 128;
      if (is_run) count -= 128;
      if (count == 0 || count > width - x || (!is_run && in->size() < count + 1)) return false;
      for (size_t i = 0; i < count; ++i) (*row)[4 * (x + i) + c] = (*in)[is_run ? 1 : 1 + i];
      x += count;
      *in = in->subspan(is_run ? 2 : count + 1);
    }
  }
  return true;
}

// Plain texels; one of mantissas 1 1 1 repeats the one before (the packing before 1991).
bool read_plain_row(std::span<const uint8_t>* in, size_t width, std::vector<uint8_t>* row) {
  int shift = 0;
  for (size_t x = 0; x < width;) {
    if (in->size() < 4) return false;
    const auto texel = in->first(4);
    *in = in->subspan(4);
    if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
      const size_t count = size_t{texel[3]} << shift;
      if (x == 0 || count > width - x) return false;
      for (size_t i = 0; i < count; ++i)
        std::copy_n(row->begin() + static_cast<std::ptrdiff_t>(4 * (x - 1)), 4,
                    row->begin() + static_cast<std::ptrdiff_t>(4 * (x + i)));
      x += count;
      shift = std::min(shift + 8, 24);
    } else {
      std::copy(texel.begin(), texel.end(), row->begin() + static_cast<std::ptrdiff_t>(4 * x));
      ++x;
      shift = 0;
    }
  }
  return true;
}

}  // namespace

Result<ImageF> decode_hdr(std::span<const uint8_t> bytes, const std::string& name,
                          uint64_t max_pixels) {
  const auto bad = [&name](const std::string& what) {
    return Error{
        ErrorKind::kInput, fmt::format("not a readable HDR image: {}", what), {name, 0, 0}};
  };
  HdrHeader header;
  std::span<const uint8_t> in = bytes;
  if (const std::string why = read_hdr_header(&in, &header); !why.empty()) return bad(why);
  const auto width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
  if (uint64_t{width} * height > max_pixels)
    return bad(fmt::format("it has {} x {} pixels; the limit is {}", width, height, max_pixels));
  ImageF out{static_cast<int>(width), static_cast<int>(height), 3, {}};
  std::vector<uint8_t> row(4 * width);
  for (size_t y = 0; y < height; ++y) {  // memory grows with what the file really holds
    const bool is_packed = width >= 8 && width < 32768 && in.size() >= 4 && in[0] == 2 &&
                           in[1] == 2 && size_t{in[2]} * 256 + in[3] == width;
    if (!(is_packed ? read_packed_row(&in, width, &row) : read_plain_row(&in, width, &row)))
      return bad(
          fmt::format("row {} is damaged or missing, at byte {}", y, bytes.size() - in.size()));
    for (size_t x = 0; x < width; ++x) {
      const uint8_t* texel = row.data() + 4 * x;
      const float scale =
          texel[3] == 0 ? 0.0f : std::ldexp(1.0f / header.exposure, int{texel[3]} - 136);
      for (size_t c = 0; c < 3; ++c) out.texels.push_back(static_cast<float>(texel[c]) * scale);
    }
  }
  if (header.upwards) {
    for (size_t y = 0; y < height / 2; ++y)
      std::swap_ranges(
          out.texels.begin() + static_cast<std::ptrdiff_t>(3 * width * y),
          out.texels.begin() + static_cast<std::ptrdiff_t>(3 * width * (y + 1)),
          out.texels.begin() + static_cast<std::ptrdiff_t>(3 * width * (height - 1 - y)));
  }
  return out;
}

}  // namespace gloam

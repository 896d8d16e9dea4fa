// The parts of "OpenEXR File Layout" (https://openexr.com/en/latest/OpenEXRFileLayout.html) that
// depth and colour files use.

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "geometry/image/image_exr.h"
#include "geometry/image/small_float.h"

namespace gloam {
namespace {

constexpr uint32_t kExrMagic = 20000630;
constexpr int64_t kMaxSize = 16384;
// Greatest ratio of zlib: a file cannot hold more than this
constexpr uint64_t kMaxDeflateRatio = 1032;
enum PixelType : uint32_t { kUint = 0, kHalf = 1, kFloat = 2 };
enum Compression : uint8_t { kNone = 0, kZips = 2, kZip = 3 };

/// Little-endian reads that remember whether the data ran out.
class Cursor {
 public:
  explicit Cursor(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  bool ok() const { return ok_; }
  std::span<const uint8_t> take(uint64_t n) {
    if (!ok_ || n > bytes_.size() - at_) {
      ok_ = false;
      return {};
    }
    at_ += n;
    return bytes_.subspan(at_ - n, n);
  }
  uint8_t u8() {
    const auto b = take(1);
    return ok_ ? b[0] : uint8_t{0};
  }
  uint32_t u32() {
    const auto b = take(4);
    if (!ok_) return 0;
    return b[0] | (uint32_t{b[1]} << 8) | (uint32_t{b[2]} << 16) | (uint32_t{b[3]} << 24);
  }
  int32_t i32() { return static_cast<int32_t>(u32()); }
  uint64_t u64() {
    const uint64_t low = u32();
    return low | (uint64_t{u32()} << 32);
  }
  std::string text() {
    std::string out;
    for (uint8_t c; (c = u8()) != 0 && ok_ && out.size() < 256;) out += static_cast<char>(c);
    return out;
  }

 private:
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  bool ok_ = true;
};

struct ExrHeader {
  std::vector<std::pair<std::string, uint32_t>> channels;  // name, PixelType
  uint8_t compression = 255;
  int64_t min_y = 0, width = 0, height = 0;
  size_t row_bytes = 0;
};

/// "" or the fault.
std::string read_channels(Cursor cursor, ExrHeader* header) {
  for (;;) {
    const std::string name = cursor.text();
    if (!cursor.ok()) return "its channel list is damaged";
    if (name.empty()) return header->channels.empty() ? "it has no channels" : "";
    const uint32_t type = cursor.u32();
    cursor.take(4);
    if (cursor.i32() != 1 || cursor.i32() != 1)
      return fmt::format("channel '{}' is subsampled", name);
    if (type > kFloat) return fmt::format("channel '{}' has an unknown type", name);
    if (header->channels.size() == 64) return "it has more than 64 channels";
    header->channels.emplace_back(name, type);
  }
}

std::string read_exr_header(Cursor* cursor, ExrHeader* header) {
  if (cursor->u32() != kExrMagic) return "it is not an EXR file";
  const uint32_t version = cursor->u32();
  if ((version & 0xff) != 2) return "its version is not 2";
  if ((version & ~uint32_t{0x4ff}) != 0)
    return "tiled, deep and multi-part files are not supported";
  for (;;) {
    const std::string name = cursor->text();
    if (name.empty()) break;
    (void)cursor->text();  // the type; what we read has fixed ones
    const auto value = cursor->take(cursor->u32());
    if (!cursor->ok()) return "its header is damaged";
    Cursor in(value);
    if (name == "channels") {
      header->channels.clear();
      if (std::string wrong = read_channels(in, header); !wrong.empty()) return wrong;
    } else if (name == "compression") {
      header->compression = in.u8();
    } else if (name == "dataWindow") {
      const int64_t min_x = in.i32(), min_y = in.i32(), max_x = in.i32(), max_y = in.i32();
      header->min_y = min_y;
      header->width = max_x - min_x + 1;
      header->height = max_y - min_y + 1;
    }
    if (!in.ok()) return "its header is damaged";
  }
  if (!cursor->ok() || header->channels.empty()) return "its header is damaged";
  if (header->width <= 0 || header->height <= 0 || header->width > kMaxSize ||
      header->height > kMaxSize)
    return fmt::format("its size is {} x {}", header->width, header->height);
  if (header->compression != kNone && header->compression != kZips && header->compression != kZip)
    return "only uncompressed and ZIP files are supported";
  for (const auto& [name, type] : header->channels)
    header->row_bytes += static_cast<size_t>(header->width) * (type == kHalf ? 2 : 4);
  return "";
}

/// Undoes deflate, differences of bytes, and their split into even and odd ones.
bool expand(std::span<const uint8_t> packed, size_t size, std::vector<uint8_t>* out) {
  out->assign(size, 0);
  if (packed.size() == size) {  // incompressible data is stored
    std::copy(packed.begin(), packed.end(), out->begin());
    return true;
  }
  std::vector<uint8_t> split(size);
  uLongf length = size;
  if (uncompress(split.data(), &length, packed.data(), packed.size()) != Z_OK || length != size)
    return false;
  for (size_t i = 1; i < size; ++i) split[i] = static_cast<uint8_t>(split[i - 1] + split[i] - 128);
  const size_t half = (size + 1) / 2;
  for (size_t i = 0; i < size; ++i) (*out)[i] = split[i % 2 == 0 ? i / 2 : half + i / 2];
  return true;
}

void read_row(const ExrHeader& header, Cursor* in, size_t y, ExrImage* image) {
  const size_t width = static_cast<size_t>(header.width);
  for (size_t c = 0; c < header.channels.size(); ++c) {
    const uint32_t type = header.channels[c].second;
    float* row = image->planes[c].data() + y * width;
    for (size_t x = 0; x < width; ++x) {
      if (type == kHalf) {
        const uint8_t low = in->u8();
        row[x] = half_to_float(static_cast<uint16_t>(low | (in->u8() << 8)));
      } else {
        const uint32_t bits = in->u32();
        row[x] = type == kFloat ? std::bit_cast<float>(bits) : static_cast<float>(bits);
      }
    }
  }
}

}  // namespace

const std::vector<float>* ExrImage::find(const std::string& name) const {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return &planes[i];
  return nullptr;
}

Result<ExrImage> decode_exr(std::span<const uint8_t> bytes, const std::string& name,
                            uint64_t max_values) {
  const auto bad = [&name](const std::string& what) {
    return Error{
        ErrorKind::kInput, fmt::format("not a readable EXR image: {}", what), {name, 0, 0}};
  };
  Cursor cursor(bytes);
  ExrHeader header;
  if (const std::string wrong = read_exr_header(&cursor, &header); !wrong.empty())
    return bad(wrong);
  const size_t width = static_cast<size_t>(header.width);
  const size_t height = static_cast<size_t>(header.height);
  const uint64_t values = uint64_t{width} * height * header.channels.size();
  if (values > max_values)
    return bad(fmt::format("it has {} values; the limit is {}", values, max_values));
  if (header.row_bytes * height > bytes.size() * kMaxDeflateRatio) return bad("it is truncated");

  ExrImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  for (const auto& [channel, type] : header.channels) {
    image.names.push_back(channel);
    image.planes.emplace_back(width * height, 0.0f);
  }
  const size_t block = header.compression == kZip ? 16 : 1;  // rows
  std::vector<uint8_t> rows;
  for (size_t first = 0; first < height; first += block) {
    const uint64_t offset = cursor.u64();
    if (!cursor.ok() || offset > bytes.size()) return bad("its offset table is damaged");
    Cursor chunk(bytes.subspan(offset));
    const int64_t y = int64_t{chunk.i32()} - header.min_y;
    const auto packed = chunk.take(chunk.u32());
    if (!chunk.ok() || y < 0 || static_cast<size_t>(y) >= height ||
        static_cast<size_t>(y) % block != 0)
      return bad("its scan lines are damaged");
    const size_t count = std::min(block, height - static_cast<size_t>(y));
    if (!expand(packed, count * header.row_bytes, &rows)) return bad("its scan lines are damaged");
    Cursor in(rows);
    for (size_t i = 0; i < count; ++i) read_row(header, &in, static_cast<size_t>(y) + i, &image);
  }
  return image;
}

}  // namespace gloam

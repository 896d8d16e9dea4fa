#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "geometry/image/image_file.h"
#include "geometry/image/small_float.h"

namespace gloam {
namespace {

constexpr std::array<uint8_t, 12> kIdentifier = {0xAB, 'K',  'T',  'X',  ' ',  '1',
                                                 '1',  0xBB, '\r', '\n', 0x1A, '\n'};
constexpr size_t kKtxHeaderBytes = 64;
constexpr uint32_t kMaxKtxSide = 16384;

// The numbers of OpenGL's enumerations.
enum : uint32_t {
  kUnsignedByte = 0x1401,
  kGlFloat = 0x1406,
  kGlHalf = 0x140B,
  kPacked11f = 0x8C3B,  // UNSIGNED_INT_10F_11F_11F_REV
  kRed = 0x1903,
  kRg = 0x8227,
  kRgb = 0x1907,
  kRgba = 0x1908,
  kSrgb = 0x8C40,
  kSrgb8 = 0x8C41,
  kSrgbAlpha = 0x8C42,
  kSrgb8Alpha8 = 0x8C43,
};

class KtxReader {
 public:
  KtxReader(std::span<const uint8_t> bytes, std::string name, uint64_t max_pixels)
      : bytes_(bytes), name_(std::move(name)), max_pixels_(max_pixels) {}

  Result<KtxImage> read() {
    if (bytes_.size() < kKtxHeaderBytes ||
        !std::equal(kIdentifier.begin(), kIdentifier.end(), bytes_.begin()))
      return bad("it is not a KTX 1 file");
    uint32_t order;
    std::memcpy(&order, bytes_.data() + 12, 4);
    if (order != 0x04030201 && order != 0x01020304) return bad("its byte order is damaged");
    is_swapped_ = order == 0x01020304;
    type_ = u32(16);
    const uint32_t format = u32(24), internal = u32(28);
    width_ = u32(36);
    height_ = u32(40);
    if (type_ == 0 || format == 0)
      return bad(fmt::format(
          "it is compressed (format 0x{:04x}); only uncompressed texels are supported", internal));
    is_srgb_ = internal == kSrgb || internal == kSrgb8 || internal == kSrgbAlpha ||
               internal == kSrgb8Alpha8;
    channels_ = format == kRed    ? 1
                : format == kRg   ? 2
                : format == kRgb  ? 3
                : format == kRgba ? 4
                                  : 0;
    if (channels_ == 0) return bad(fmt::format("its format 0x{:04x} is not supported", format));
    texel_bytes_ = type_ == kUnsignedByte                  ? channels_
                   : type_ == kGlHalf                      ? 2 * channels_
                   : type_ == kGlFloat                     ? 4 * channels_
                   : type_ == kPacked11f && channels_ == 3 ? 4
                                                           : 0;
    if (texel_bytes_ == 0) return bad(fmt::format("its type 0x{:04x} is not supported", type_));
    return read_faces();
  }

 private:
  Error bad(const std::string& what) const {
    return {ErrorKind::kInput,
            fmt::format("not a readable KTX image: {}", what),
            {name_, 0, 0},
            "convert it to PNG or to uncompressed KTX 1"};
  }
  uint32_t u32(size_t at) const {
    uint32_t v;
    std::memcpy(&v, bytes_.data() + at, 4);
    return is_swapped_ ? __builtin_bswap32(v) : v;
  }

  Result<KtxImage> read_faces() {
    const uint32_t depth = u32(44), array = u32(48), faces = u32(52), metadata = u32(60);
    if (depth > 1 || array != 0 || height_ == 0)
      return bad("it is 1-D, 3-D or an array; only 2-D images and cube maps are supported");
    if (faces != 1 && !(faces == 6 && width_ == height_))
      return bad(fmt::format("it has {} faces of {} x {}", faces, width_, height_));
    if (width_ == 0 || width_ > kMaxKtxSide || height_ > kMaxKtxSide ||
        uint64_t{width_} * height_ * faces > max_pixels_)
      return bad(fmt::format("its size is {} x {}", width_, height_));
    const size_t row = (width_ * texel_bytes_ + 3) / 4 * 4, size = row * height_;
    const uint64_t start = kKtxHeaderBytes + uint64_t{metadata} + 4;  // start of the largest level
    if (start > bytes_.size() || faces * uint64_t{size} > bytes_.size() - start)
      return bad(fmt::format("it is truncated: {} faces of {} bytes from byte {} do not fit", faces,
                             size, start));
    if (u32(start - 4) != size)
      return bad(fmt::format("its level has {} bytes, expected {}", u32(start - 4), size));
    const auto heads = bytes_.subspan(kKtxHeaderBytes, metadata);
    constexpr std::string_view kBottomUpOrientation = "T=u";
    const bool upwards = std::search(heads.begin(), heads.end(), kBottomUpOrientation.begin(),
                                     kBottomUpOrientation.end()) != heads.end();
    KtxImage out;
    for (uint32_t f = 0; f < faces; ++f) {
      if (type_ == kUnsignedByte)
        out.faces.push_back({int(width_),
                             int(height_),
                             int(channels_),
                             is_srgb_ ? ColorSpace::kSrgb : ColorSpace::kLinear,
                             {}});
      else
        out.float_faces.push_back({int(width_), int(height_), int(channels_), {}});
      for (size_t y = 0; y < height_; ++y) {
        const size_t from = start + f * size + row * (upwards ? height_ - 1 - y : y);
        const auto texels = bytes_.subspan(from, width_ * texel_bytes_);
        if (type_ == kUnsignedByte)
          out.faces.back().texels.insert(out.faces.back().texels.end(), texels.begin(),
                                         texels.end());
        else
          add_floats(texels, &out.float_faces.back().texels);
      }
    }
    return out;
  }

  void add_floats(std::span<const uint8_t> texels, std::vector<float>* out) const {
    const size_t base = static_cast<size_t>(texels.data() - bytes_.data());
    if (type_ == kGlHalf) {
      for (size_t i = 0; i < texels.size(); i += 2)
        out->push_back(half_to_float(static_cast<uint16_t>(
            is_swapped_ ? texels[i] << 8 | texels[i + 1] : texels[i + 1] << 8 | texels[i])));
      return;
    }
    for (size_t i = 0; i < texels.size(); i += 4) {
      const uint32_t bits = u32(base + i);
      if (type_ == kGlFloat)
        out->push_back(std::bit_cast<float>(bits));
      else
        out->insert(out->end(), {small_float(bits & 0x7ff, 6), small_float(bits >> 11 & 0x7ff, 6),
                                 small_float(bits >> 22, 5)});
    }
  }

  std::span<const uint8_t> bytes_;
  std::string name_;
  uint64_t max_pixels_;
  bool is_swapped_ = false, is_srgb_ = false;
  uint32_t type_ = 0, width_ = 0, height_ = 0;
  size_t channels_ = 0, texel_bytes_ = 0;
};

}  // namespace

Result<KtxImage> decode_ktx(std::span<const uint8_t> bytes, const std::string& name,
                            uint64_t max_pixels) {
  return KtxReader(bytes, name, max_pixels).read();
}

}  // namespace gloam

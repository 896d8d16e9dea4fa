#include "geometry/volume_file.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include "base/files.h"
#include "base/memory.h"

namespace gloam {
namespace {

constexpr size_t kLongestHead = 4096;  // a plain array's has about 120 bytes

struct Head {
  size_t size = 0;  ///< bytes before the values
  bool is_double = false;
  uint64_t shape[3] = {};  ///< nz, ny, nx
};

class HeadReader {
 public:
  HeadReader(std::span<const uint8_t> bytes, std::string name)
      : bytes_(bytes), name_(std::move(name)) {}

  Result<Head> read();

 private:
  Error bad(const std::string& what) const {
    return {ErrorKind::kInput,
            fmt::format("'{}' {}", name_, what),
            {},
            "create it with numpy.save() from a float32 array of shape (nz, ny, nx)"};
  }
  /// The text behind 'key': in the dictionary; empty when it is not there.
  static std::string_view value_of(std::string_view text, std::string_view key) {
    for (const char quote : {'\'', '"'}) {
      const std::string quoted = quote + std::string(key) + quote;
      const size_t at = text.find(quoted);
      if (at == std::string_view::npos) continue;
      std::string_view rest = text.substr(at + quoted.size());
      const size_t begin = rest.find_first_not_of(" :");
      return begin == std::string_view::npos ? std::string_view() : rest.substr(begin);
    }
    return {};
  }
  Status read_shape(std::string_view text, Head* head) const;

  std::span<const uint8_t> bytes_;
  std::string name_;
};

Status HeadReader::read_shape(std::string_view text, Head* head) const {
  if (!text.starts_with('(')) return bad("has no shape");
  text.remove_prefix(1);
  for (uint64_t& n : head->shape) {
    text.remove_prefix(std::min(text.find_first_not_of(" ,"), text.size()));
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (code != std::errc()) return bad("is not a grid along three axes");
    text.remove_prefix(static_cast<size_t>(end - text.data()));
  }
  text.remove_prefix(std::min(text.find_first_not_of(" ,"), text.size()));
  if (!text.starts_with(')')) return bad("is not a grid along three axes");
  return {};
}

Result<Head> HeadReader::read() {
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (bytes_.size() < 12 || std::memcmp(bytes_.data(), kMagic.data(), kMagic.size()) != 0)
    return bad("is not an .npy file");
  const uint8_t version = bytes_[6];
  if (version < 1 || version > 3) return bad(fmt::format("has an unknown version {}", version));
  const size_t first = version == 1 ? 10 : 12;
  uint64_t length = bytes_[8] | uint64_t{bytes_[9]} << 8;
  if (version > 1) length |= uint64_t{bytes_[10]} << 16 | uint64_t{bytes_[11]} << 24;
  if (length > kLongestHead || first + length > bytes_.size()) return bad("has a damaged header");
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()) + first, length);

  Head head;
  head.size = first + length;
  const std::string_view type = value_of(text, "descr");
  if (type.size() < 5 || type.substr(1, 3) == ">f4" || type.substr(1, 3) == ">f8" ||
      (type.substr(1, 3) != "<f4" && type.substr(1, 3) != "<f8")) {
    return bad("does not contain little-endian float32 or float64");
  }
  head.is_double = type[3] == '8';
  if (!value_of(text, "fortran_order").starts_with("False"))
    return bad("is not in C order (its last axis is not the fastest)");
  GLOAM_TRY_STATUS(read_shape(value_of(text, "shape"), &head));
  return head;
}

/// `size` of the whole file.
Result<uint64_t> count_voxels(const Head& head, uint64_t size, const std::string& name,
                              uint64_t max_voxels) {
  uint64_t count = 1;
  for (const uint64_t n : head.shape) {
    if (n == 0) return Error{ErrorKind::kInput, fmt::format("'{}' has no voxels", name)};
    // max_voxels is far below the square root of what 64 bits hold.
    count = n > max_voxels ? max_voxels + 1 : count * n;
    if (count > max_voxels) {
      return Error{ErrorKind::kInput,
                   fmt::format("'{}' has {} x {} x {} voxels; the limit is {}", name, head.shape[2],
                               head.shape[1], head.shape[0], max_voxels),
                   {},
                   "use fewer voxels or several volumes"};
    }
  }
  const uint64_t expected = head.size + count * (head.is_double ? 8 : 4);
  if (size != expected) {
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' has {} bytes, but its shape requires {}", name, size, expected)};
  }
  return count;
}

}  // namespace

Result<VolumeFile> decode_npy(std::span<const uint8_t> bytes, const std::string& name,
                              uint64_t max_voxels) {
  static_assert(std::endian::native == std::endian::little);
  GLOAM_TRY(const Head head, HeadReader(bytes, name).read());
  GLOAM_TRY(const uint64_t count, count_voxels(head, bytes.size(), name, max_voxels));
  VolumeFile out;
  out.nz = static_cast<int>(head.shape[0]);
  out.ny = static_cast<int>(head.shape[1]);
  out.nx = static_cast<int>(head.shape[2]);
  out.values.resize(count);
  const uint8_t* from = bytes.data() + head.size;
  for (uint64_t i = 0; i < count; ++i) {
    double value = 0;
    if (head.is_double) {
      std::memcpy(&value, from + 8 * i, 8);
    } else {
      float single = 0;
      std::memcpy(&single, from + 4 * i, 4);
      value = single;
    }
    out.values[i] = static_cast<float>(value);
    if (!(value >= 0 && std::isfinite(out.values[i]))) {
      return Error{
          ErrorKind::kInput,
          fmt::format("'{}' contains {} at voxel {}; values must be finite and not negative", name,
                      value, i)};
    }
  }
  return out;
}

Result<VolumeFile> read_npy(const std::filesystem::path& path, uint64_t max_voxels) {
  const std::string name = path.filename().string();
  std::error_code code;
  const uint64_t size = std::filesystem::file_size(path, code);
  if (!code && std::filesystem::is_regular_file(path, code)) {
    std::vector<uint8_t> start(std::min<uint64_t>(size, kLongestHead + 12));
    std::ifstream in(path, std::ios::binary);
    in.read(reinterpret_cast<char*>(start.data()), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    GLOAM_TRY(const Head head, HeadReader(start, name).read());
    GLOAM_TRY(const uint64_t count, count_voxels(head, size, name, max_voxels));
    GLOAM_TRY_STATUS(check_memory(size + count * sizeof(float), fmt::format("reading '{}'", name),
                                  "use fewer voxels"));
  }
  GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(path, kLongestHead + 12 + 8 * max_voxels));
  return decode_npy(bytes, name, max_voxels);
}

}  // namespace gloam

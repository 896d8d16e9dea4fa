#include "base/plain_text.h"

#include <array>
#include <cstring>

#include "base/files.h"
#include "base/text.h"

namespace gloam {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF", kLittleMark = "\xFF\xFE",
                           kBigMark = "\xFE\xFF";

void append_utf8(uint32_t c, std::string* out) {
  const auto put = [&](uint32_t byte) { out->push_back(static_cast<char>(byte)); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0 | c >> 6), put(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    put(0xE0 | c >> 12), put(0x80 | (c >> 6 & 0x3F)), put(0x80 | (c & 0x3F));
  } else {
    put(0xF0 | c >> 18), put(0x80 | (c >> 12 & 0x3F)), put(0x80 | (c >> 6 & 0x3F));
    put(0x80 | (c & 0x3F));
  }
}

// RFC 2781; halves of pairs that stand alone become U+FFFD.
std::string from_utf16(std::string_view bytes, bool is_big) {
  std::string out;
  const auto unit = [&](size_t i) -> uint32_t {
    const auto low = static_cast<uint8_t>(bytes[i + (is_big ? 1 : 0)]);
    const auto high = static_cast<uint8_t>(bytes[i + (is_big ? 0 : 1)]);
    return low | static_cast<uint32_t>(high) << 8;
  };
  for (size_t i = 0; i + 1 < bytes.size(); i += 2) {
    uint32_t c = unit(i);
    const bool leads = c >= 0xD800 && c < 0xDC00;
    const uint32_t next = leads && i + 3 < bytes.size() ? unit(i + 2) : 0;
    if (next >= 0xDC00 && next < 0xE000) {
      c = 0x10000 + ((c - 0xD800) << 10) + (next - 0xDC00);
      i += 2;
    } else if (c >= 0xD800 && c < 0xE000) {
      c = 0xFFFD;
    }
    append_utf8(c, &out);
  }
  return out;
}

// Code points of the bytes 0x80 to 0x9F (WHATWG Encoding Standard, windows-1252); those from 0xA0
// on are their own.
constexpr std::array<uint16_t, 32> kWindows1252 = {
    0x20AC, 0x0081, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0x008D, 0x017D, 0x008F, 0x0090, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x009D, 0x017E, 0x0178};

/// Length of the part at the front that is UTF-8.
size_t utf8_part(std::string_view text) {
  size_t at = 0;
  while (at < text.size()) {
    uint64_t eight = 0;
    while (at + 8 <= text.size()) {  // ASCII
      std::memcpy(&eight, text.data() + at, 8);
      if ((eight & 0x8080808080808080U) != 0) break;
      at += 8;
    }
    if (at == text.size()) break;
    const size_t length = utf8_length(text.substr(at));
    if (length == 0) break;
    at += length;
  }
  return at;
}

std::string from_windows_1252(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 16);
  while (!text.empty()) {
    const size_t valid = utf8_part(text);
    out += text.substr(0, valid);
    text.remove_prefix(valid);
    if (text.empty()) break;
    const auto byte = static_cast<uint8_t>(text.front());
    append_utf8(byte < 0xA0 ? kWindows1252[byte - 0x80U] : byte, &out);
    text.remove_prefix(1);
  }
  return out;
}

bool has_old_line_ends(std::string_view text) {
  return text.find('\r') != std::string_view::npos && text.find('\n') == std::string_view::npos &&
         text.find('\r') + 1 < text.size();
}

}  // namespace

Result<std::optional<std::string>> plain_text(std::string_view bytes, const std::string& file) {
  std::string owned;
  std::string_view text = bytes;
  if (text.starts_with(kUtf8Mark)) {
    text.remove_prefix(kUtf8Mark.size());
  } else if (text.starts_with(kLittleMark) || text.starts_with(kBigMark)) {
    if (text.size() % 2 != 0)
      return Error{ErrorKind::kInput,
                   "is UTF-16 text that ends with half a character",
                   {file, 0, 0},
                   "the file may be truncated: copy it again, or save it as UTF-8"};
    owned = from_utf16(text.substr(2), text.starts_with(kBigMark));
    text = owned;
  }
  while (!text.empty() && (text.back() == '\0' || text.back() == '\x1A')) text.remove_suffix(1);
  if (utf8_part(text) < text.size()) {
    owned = from_windows_1252(text);
    text = owned;
  }
  const bool is_old = has_old_line_ends(text);
  if (owned.empty() && text.size() == bytes.size() && !is_old) return std::optional<std::string>();
  std::string out(text);
  if (is_old)
    for (char& c : out)
      if (c == '\r') c = '\n';
  return std::optional(std::move(out));
}

bool is_lfs_pointer(std::string_view bytes) {
  return bytes.size() < 1024 && bytes.starts_with("version https://git-lfs.github.com/spec/");
}

Error lfs_pointer_error(const std::string& file) {
  return {ErrorKind::kInput,
          "is a Git LFS pointer, not the file itself",
          {file, 0, 0},
          "run 'git lfs pull' in its repository"};
}

Result<std::string> read_plain_text(const std::filesystem::path& path, uint64_t max_size) {
  GLOAM_TRY(std::string bytes, read_text_file(path, max_size));
  if (is_lfs_pointer(bytes)) return lfs_pointer_error(path.string());
  GLOAM_TRY(std::optional<std::string> plain, plain_text(bytes, path.string()));
  return plain ? std::move(*plain) : std::move(bytes);
}

}  // namespace gloam

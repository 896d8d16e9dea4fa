#include "base/plain_text.h"

#include "base/files.h"

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
                   "is UTF-16 text with half a character at its end",
                   {file, 0, 0},
                   "the file may be cut off: copy it again, or save it as UTF-8"};
    owned = from_utf16(text.substr(2), text.starts_with(kBigMark));
    text = owned;
  }
  while (!text.empty() && (text.back() == '\0' || text.back() == '\x1A')) text.remove_suffix(1);
  const bool is_old = has_old_line_ends(text);
  if (text.size() == bytes.size() && !is_old) return std::optional<std::string>();
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

#include "bridge/zmq/pack.h"

#include <fmt/format.h>

namespace gloam::bridge::zeromq {
namespace {

const char* kind_name(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInput:
      return "input";
    case ErrorKind::kIo:
      return "io";
    case ErrorKind::kUsage:
      return "usage";
    case ErrorKind::kPartial:
      return "partial";
    case ErrorKind::kDiverged:
      return "diverged";
    case ErrorKind::kUnsupported:
      return "unsupported";
    case ErrorKind::kInterrupted:
      return "interrupted";
  }
  return "input";
}

std::string place_of(const SourceLoc& loc) {
  if (loc.file.empty()) return {};
  if (loc.line == 0) return loc.file;
  if (loc.column == 0) return fmt::format("{}:{}", loc.file, loc.line);
  return fmt::format("{}:{}:{}", loc.file, loc.line, loc.column);
}

// Bytes of the character at the start of a text; 0 if it is none (table 3-7 of Unicode).
size_t character_length(std::string_view text) {
  const auto byte = [text](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  const unsigned char second = byte(1);
  const bool is_fit = (first != 0xe0 || second >= 0xa0) && (first != 0xed || second < 0xa0) &&
                      (first != 0xf0 || second >= 0x90) && (first != 0xf4 || second < 0x90);
  return is_fit ? length : 0;
}

}  // namespace

std::string valid_text(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const size_t length = character_length(text);
    if (length == 0)
      valid += '?';
    else
      valid += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return valid;
}

void pack_error(Packer& packer, const Error& error) {
  packer.pack_map(4);
  pack_pair(packer, "kind", std::string_view(kind_name(error.kind)));
  pack_pair(packer, "message", valid_text(error.message));
  pack_pair(packer, "remedy", valid_text(error.hint));
  pack_pair(packer, "where", valid_text(place_of(error.loc)));
}

}  // namespace gloam::bridge::zeromq

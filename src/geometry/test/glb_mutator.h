#pragma once
// Damaged GLB whose chunks are whole: its JSON changes, lengths follow.

#include <cstring>
#include <string>

#include "base/test/json_mutator.h"

namespace gloam {

/// Bytes that are no GLB with JSON stay.
inline std::string mutate_glb(const std::string& file, uint64_t seed) {
  constexpr size_t kHead = 12, kChunkHead = 8;
  const auto u32_at = [&](size_t at) {
    uint32_t value;
    std::memcpy(&value, file.data() + at, sizeof(value));
    return size_t{value};
  };
  if (file.size() < kHead + kChunkHead || !file.starts_with("glTF")) return file;
  const size_t length = u32_at(kHead);
  if (length > file.size() - kHead - kChunkHead) return file;
  std::string json = mutate_json(file.substr(kHead + kChunkHead, length), seed);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out =
      file.substr(0, kHead + kChunkHead) + json + file.substr(kHead + kChunkHead + length);
  const auto put = [&](size_t at, size_t value) {
    const auto number = static_cast<uint32_t>(value);
    std::memcpy(out.data() + at, &number, sizeof(number));
  };
  put(8, out.size());
  put(kHead, json.size());
  return out;
}

}  // namespace gloam

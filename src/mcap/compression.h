#pragma once
// Compression of chunks: zstd and lz4 frames, or none.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gloam {

/// zstd with one context for all calls.
class ZstdCompressor {
 public:
  /// `level`: 1 (fastest) to 19.
  explicit ZstdCompressor(int level);
  ~ZstdCompressor();

  /// Appends one frame. False, and nothing is appended, where the frame would be larger than
  /// `most` bytes.
  bool append(std::span<const uint8_t> bytes, size_t most, std::vector<uint8_t>* out);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
  int level_;
};

/// Fills `out`, whose size is what the chunk declares, from a stranger's bytes; returns what is
/// wrong, or "". Never writes beyond `out`. `compression`: "zstd", "lz4" or "".
std::string decompress(const std::string& compression, std::span<const uint8_t> bytes,
                       std::span<uint8_t> out);

}  // namespace gloam

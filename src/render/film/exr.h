#pragma once
// OpenEXR files in memory: float planes without loss.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// One channel to write: element i of the picture is data[i * stride].
struct ExrChannel {
  std::string name;  ///< "R", "G", "B", "Z" (depth [m]), or "layer.name"
  const float* data = nullptr;
  int stride = 1;     ///< [floats]
  bool half = false;  ///< store 16 bits instead of 32
};

/// Scan-line file, ZIP compression. The channels' order does not matter (EXR sorts them).
Result<std::vector<uint8_t>> encode_exr(int width, int height,
                                        std::span<const ExrChannel> channels);

struct ExrImage {
  int width = 0, height = 0;
  std::vector<std::string> names;          ///< of the channels
  std::vector<std::vector<float>> planes;  ///< one per name, (height x width)
  /// The plane of this name, or null.
  const std::vector<float>* find(const std::string& name) const;
};

/// Reads single-part scan-line files, uncompressed or ZIP, whose channels are not subsampled. Own
/// code, because OpenEXR 3.1's reader asks for any amount of memory that a damaged header names.
/// `name` is for messages. Errors: not EXR, damaged, of another kind, larger than 16384 x 16384 or
/// more than `max_values` values in all.
Result<ExrImage> decode_exr(std::span<const uint8_t> bytes, const std::string& name,
                            uint64_t max_values = uint64_t{1} << 28);

}  // namespace gloam

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

}  // namespace gloam

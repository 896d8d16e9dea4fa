#pragma once
// Pictures for people.

#include <cstdint>
#include <span>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Baseline JPEG, 4:2:0, of 8-bit sRGB (height x width x 3). `quality` 1 … 100. Errors: `rgb` does
/// not have the size of the picture, a side is not 1 … 65500 px, no memory.
Result<std::vector<uint8_t>> encode_jpeg(int width, int height, std::span<const uint8_t> rgb,
                                         int quality = 88);

}  // namespace gloam

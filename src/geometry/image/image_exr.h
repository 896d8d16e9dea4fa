#pragma once
// Reads OpenEXR files: float planes without loss.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

struct ExrImage {
  int width = 0, height = 0;
  std::vector<std::string> names;          ///< names of the channels
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

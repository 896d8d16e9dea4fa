#pragma once
// Sink for the bytes of a file that grows. Errors are returned, never thrown: a disk may fill up.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "gloam/result.h"

namespace gloam {

class ByteSink {
 public:
  virtual ~ByteSink() = default;
  /// Adds bytes at the end. After an error the end may hold a part of them.
  virtual Status append(std::span<const uint8_t> bytes) = 0;
  /// Replaces bytes that were appended before, from `offset` on.
  virtual Status overwrite(uint64_t offset, std::span<const uint8_t> bytes) = 0;
  /// Cuts the end off, so that `size` bytes are left.
  virtual Status truncate(uint64_t size) = 0;
  /// Hands everything to the operating system and reports what it says.
  virtual Status close() = 0;
};

/// A new file at `path`. Errors: it exists already, no such folder, no permission.
Result<std::unique_ptr<ByteSink>> create_file_sink(const std::filesystem::path& path);

}  // namespace gloam

#pragma once
// Bytes of a log that is read: a file, or memory in tests.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// May be read by many threads at once.
class LogSource {
 public:
  virtual ~LogSource() = default;
  /// For errors.
  virtual const std::string& name() const = 0;
  /// As it was when the source was opened [bytes].
  virtual uint64_t size() const = 0;
  /// Fills `out` with the bytes from `offset` on. Errors: the log ends before, the disk.
  virtual Status read(uint64_t offset, std::span<uint8_t> out) const = 0;
};

/// Errors: missing, not a regular file, no permission.
Result<std::shared_ptr<const LogSource>> open_log_file(const std::filesystem::path& path);
std::shared_ptr<const LogSource> make_memory_source(std::vector<uint8_t> bytes,
                                                    std::string name = "memory");

/// "LOG: byte OFFSET: cause".
Error mcap_error(const LogSource& source, uint64_t offset, const std::string& cause,
                 std::string hint = {});

/// CRC-32 of the bytes from `begin` to `end`, read in pieces.
Result<uint32_t> crc_of_range(const LogSource& source, uint64_t begin, uint64_t end);

}  // namespace gloam

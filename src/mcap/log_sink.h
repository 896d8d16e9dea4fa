#pragma once
// Where the bytes of a log go: a file, or in tests memory and disks that fail.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "gloam/result.h"

namespace gloam {

class LogSink {
 public:
  virtual ~LogSink() = default;
  /// Appends all bytes. After an error the end may hold a part of them.
  virtual Status write(std::span<const uint8_t> bytes) = 0;
  /// Returns when all written data survives a power failure.
  virtual Status sync() = 0;
  /// May be called twice.
  virtual Status close() = 0;
};

/// A new file, locked against a second recording. Writes go to the operating system at once: they
/// outlive the end of the process. Errors of write() and close(): also that somebody has removed,
/// cut, moved or replaced the file.
class FileSink final : public LogSink {
 public:
  /// Errors: the file exists already, no such folder, no permission.
  static Result<std::unique_ptr<LogSink>> create(const std::filesystem::path& path);
  ~FileSink() override;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  Status write(std::span<const uint8_t> bytes) override;
  Status sync() override;
  Status close() override;

 private:
  FileSink(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  Error failure(const char* what) const;

  int fd_;
  std::string path_;
  uint64_t written_ = 0;  // [bytes]
};

}  // namespace gloam

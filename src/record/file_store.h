#pragma once
// The recorder's way to the disk. Tests put one in between that fails.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "gloam/result.h"
#include "render/film/byte_sink.h"

namespace gloam {

class FileStore {
 public:
  virtual ~FileStore() = default;
  virtual Status make_folder(const std::filesystem::path& path) = 0;
  /// Writes the whole file or nothing; replaces an existing file.
  virtual Status write_file(const std::filesystem::path& path, std::span<const uint8_t> bytes) = 0;
  /// A file that grows.
  virtual Result<std::unique_ptr<ByteSink>> create(const std::filesystem::path& path) = 0;
};

std::shared_ptr<FileStore> make_disk_store();

}  // namespace gloam

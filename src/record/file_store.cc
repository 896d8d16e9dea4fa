#include "record/file_store.h"

#include "base/files.h"

namespace gloam {
namespace {

class DiskStore : public FileStore {
 public:
  Status make_folder(const std::filesystem::path& path) override {
    return gloam::make_folder(path);
  }
  Status write_file(const std::filesystem::path& path, std::span<const uint8_t> bytes) override {
    return write_file_atomic(path, bytes);
  }
  Result<std::unique_ptr<ByteSink>> create(const std::filesystem::path& path) override {
    return create_file_sink(path);
  }
};

}  // namespace

std::shared_ptr<FileStore> make_disk_store() { return std::make_shared<DiskStore>(); }

}  // namespace gloam

#include "mcap/log_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "mcap/crc32.h"

namespace gloam {
namespace {

class FileSource final : public LogSource {
 public:
  FileSource(int fd, std::string name, uint64_t size)
      : fd_(fd), name_(std::move(name)), size_(size) {}
  ~FileSource() override { ::close(fd_); }
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  const std::string& name() const override { return name_; }
  uint64_t size() const override { return size_; }

  Status read(uint64_t offset, std::span<uint8_t> out) const override {
    for (size_t done = 0; done < out.size();) {
      const ssize_t n =
          ::pread(fd_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) {
        Error error = mcap_error(*this, offset + done, std::strerror(errno));
        error.kind = ErrorKind::kIo;
        return error;
      }
      if (n == 0) return mcap_error(*this, offset + done, "the log ends here");
      done += static_cast<size_t>(n);
    }
    return {};
  }

 private:
  int fd_;
  std::string name_;
  uint64_t size_;
};

class MemorySource final : public LogSource {
 public:
  MemorySource(std::vector<uint8_t> bytes, std::string name)
      : bytes_(std::move(bytes)), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }
  uint64_t size() const override { return bytes_.size(); }

  Status read(uint64_t offset, std::span<uint8_t> out) const override {
    if (offset > bytes_.size() || out.size() > bytes_.size() - offset)
      return mcap_error(*this, bytes_.size(), "the log ends here");
    if (!out.empty()) std::memcpy(out.data(), bytes_.data() + offset, out.size());
    return {};
  }

 private:
  std::vector<uint8_t> bytes_;
  std::string name_;
};

}  // namespace

Result<std::shared_ptr<const LogSource>> open_log_file(const std::filesystem::path& path) {
  const auto refused = [&](const std::string& message, std::string hint = {}) {
    return Error{ErrorKind::kIo, message, {path.string(), 0, 0}, std::move(hint)};
  };
  // O_NONBLOCK: a named pipe would keep open() waiting for its writer.
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0)
    return refused(fmt::format("cannot open the log: {}", std::strerror(errno)),
                   errno == ENOENT ? "check the path" : "check its permissions");
  struct stat found{};
  if (::fstat(fd, &found) != 0 || !S_ISREG(found.st_mode)) {
    ::close(fd);
    return refused("is not a regular file");
  }
  return std::shared_ptr<const LogSource>(
      std::make_shared<FileSource>(fd, path.string(), static_cast<uint64_t>(found.st_size)));
}

std::shared_ptr<const LogSource> make_memory_source(std::vector<uint8_t> bytes, std::string name) {
  return std::make_shared<MemorySource>(std::move(bytes), std::move(name));
}

Error mcap_error(const LogSource& source, uint64_t offset, const std::string& cause,
                 std::string hint) {
  return {ErrorKind::kInput,
          fmt::format("byte {}: {}", offset, cause),
          {source.name(), 0, 0},
          std::move(hint)};
}

Result<uint32_t> crc_of_range(const LogSource& source, uint64_t begin, uint64_t end) {
  std::vector<uint8_t> piece(std::min<uint64_t>(end - begin, uint64_t{1} << 20));
  uint32_t crc = 0;
  while (begin < end) {
    const std::span<uint8_t> now(piece.data(), std::min<uint64_t>(piece.size(), end - begin));
    GLOAM_TRY_STATUS(source.read(begin, now));
    crc = crc32_of(now, crc);
    begin += now.size();
  }
  return crc;
}

}  // namespace gloam

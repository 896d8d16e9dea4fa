#include "render/film/byte_sink.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/own_file.h"

namespace gloam {
namespace {

class FileSink : public ByteSink {
 public:
  FileSink(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  ~FileSink() override {
    if (fd_ >= 0) ::close(fd_);
  }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  Status append(std::span<const uint8_t> bytes) override {
    GLOAM_TRY_STATUS(check_not_cut(fd_, path_, end_));
    GLOAM_TRY_STATUS(write_at(end_, bytes));
    end_ += bytes.size();
    return {};
  }

  Status overwrite(uint64_t offset, std::span<const uint8_t> bytes) override {
    return write_at(offset, bytes);
  }

  Status truncate(uint64_t size) override {
    if (::ftruncate(fd_, static_cast<off_t>(size)) != 0) return failure();
    end_ = size;
    return {};
  }

  Status close() override {
    const int fd = fd_;
    if (fd < 0) return {};
    const Status in_place = check_in_place(fd, path_, end_);
    fd_ = -1;
    if (::close(fd) != 0) return failure();
    return in_place;
  }

 private:
  Status write_at(uint64_t offset, std::span<const uint8_t> bytes) {
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::pwrite(fd_, bytes.data() + done, bytes.size() - done,
                                 static_cast<off_t>(offset + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return failure();
      done += static_cast<size_t>(n);
    }
    return {};
  }

  Error failure() const {
    return {ErrorKind::kIo,
            fmt::format("cannot write: {}", std::strerror(errno)),
            {path_, 0, 0},
            "free some space or choose another folder with --out"};
  }

  int fd_;
  std::string path_;
  uint64_t end_ = 0;  // [bytes] appended and complete
};

}  // namespace

Result<std::unique_ptr<ByteSink>> create_file_sink(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) {
    return Error{ErrorKind::kIo,
                 fmt::format("cannot create the file: {}", std::strerror(errno)),
                 {path.string(), 0, 0},
                 "check the folder and its permissions"};
  }
  return std::unique_ptr<ByteSink>(new FileSink(fd, path.string()));
}

}  // namespace gloam

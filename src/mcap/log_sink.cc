#include "mcap/log_sink.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/own_file.h"

namespace gloam {

Result<std::unique_ptr<LogSink>> FileSink::create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (fd < 0) {
    const int cause = errno;
    return Error{ErrorKind::kIo,
                 fmt::format("cannot create the log: {}", std::strerror(cause)),
                 {path.string(), 0, 0},
                 cause == EEXIST ? "choose another name or remove the file"
                                 : "check the folder and its permissions"};
  }
  std::unique_ptr<FileSink> sink(new FileSink(fd, path.string()));
  GLOAM_TRY_STATUS(lock_for_writing(fd, path));
  return std::unique_ptr<LogSink>(std::move(sink));
}

FileSink::~FileSink() {
  if (fd_ >= 0) ::close(fd_);
}

Status FileSink::write(std::span<const uint8_t> bytes) {
  GLOAM_TRY_STATUS(check_not_cut(fd_, path_, written_));
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = ENOSPC;
    if (n <= 0) return failure("write the log");
    done += static_cast<size_t>(n);
    written_ += static_cast<uint64_t>(n);
  }
  return {};
}

Status FileSink::sync() {
  int status = 0;
  do status = ::fdatasync(fd_);
  while (status != 0 && errno == EINTR);
  // Pipes and some file systems have no such thing as a disk.
  if (status != 0 && errno != EINVAL && errno != EROFS) return failure("sync the log to the disk");
  return {};
}

Status FileSink::close() {
  const int fd = std::exchange(fd_, -1);
  if (fd < 0) return {};
  const Status in_place = check_in_place(fd, path_, written_);
  if (::close(fd) != 0) return failure("close the log");
  return in_place;
}

Error FileSink::failure(const char* what) const {
  const int cause = errno;
  return {ErrorKind::kIo,
          fmt::format("cannot {}: {}", what, std::strerror(cause)),
          {path_, 0, 0},
          cause == ENOSPC || cause == EDQUOT ? "free some space or record elsewhere" : ""};
}

}  // namespace gloam

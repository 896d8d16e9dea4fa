#include "base/own_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace gloam {
namespace {

Error error_of(const std::filesystem::path& path, std::string message, std::string hint = {}) {
  return {ErrorKind::kIo, std::move(message), {path.string(), 0, 0}, std::move(hint)};
}

}  // namespace

Status lock_for_writing(int fd, const std::filesystem::path& path) {
  int status = 0;
  do status = ::flock(fd, LOCK_EX | LOCK_NB);
  while (status != 0 && errno == EINTR);
  if (status == 0 || errno != EWOULDBLOCK) return {};
  return Error{ErrorKind::kUsage,
               "is being written by another recording",
               {path.string(), 0, 0},
               "wait until it has ended, or choose another name"};
}

Status remove_unless_written(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (fd >= 0) {
    const Status locked = lock_for_writing(fd, path);
    const bool in_place = check_in_place(fd, path, 0).ok();
    if (locked.ok() && in_place && ::unlink(path.c_str()) == 0) {
      ::close(fd);
      return {};
    }
    ::close(fd);
    GLOAM_TRY_STATUS(locked);
  }
  std::error_code code;
  if (std::filesystem::is_directory(std::filesystem::symlink_status(path, code)))
    return error_of(path, "is a folder, not a file", "choose another name");
  std::filesystem::remove(path, code);  // a link, or a file that may be removed but not read
  if (!code) return {};
  return error_of(path, fmt::format("cannot be replaced: {}", code.message()),
                  "choose another name or check the permissions");
}

Status check_not_cut(int fd, const std::filesystem::path& path, uint64_t size) {
  struct stat found{};
  if (::fstat(fd, &found) != 0)
    return error_of(path, fmt::format("cannot be checked: {}", std::strerror(errno)));
  if (found.st_nlink == 0) return error_of(path, "was removed while it was being written");
  if (S_ISREG(found.st_mode) && static_cast<uint64_t>(found.st_size) < size)
    return error_of(path, fmt::format("was truncated to {} of {} bytes while it was being written",
                                      found.st_size, size));
  return {};
}

Status check_in_place(int fd, const std::filesystem::path& path, uint64_t size) {
  GLOAM_TRY_STATUS(check_not_cut(fd, path, size));
  struct stat own{}, named{};
  if (::fstat(fd, &own) == 0 && ::stat(path.c_str(), &named) == 0 && own.st_ino == named.st_ino &&
      own.st_dev == named.st_dev)
    return {};
  return error_of(path, "was moved or replaced while it was being written");
}

Status FolderLock::take(const std::filesystem::path& folder) {
  folder_ = folder;
  fd_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd_ < 0) return error_of(folder, fmt::format("cannot be opened: {}", std::strerror(errno)));
  const Status locked = lock_for_writing(fd_, folder);
  if (!locked.ok()) release();
  return locked;
}

Status FolderLock::check() const { return fd_ < 0 ? Status() : check_in_place(fd_, folder_, 0); }

void FolderLock::release() {
  const int fd = std::exchange(fd_, -1);
  if (fd >= 0) ::close(fd);
}

}  // namespace gloam

#include "base/files.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <system_error>
#include <vector>

#include "base/memory.h"
#include "base/text.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

Error io_error(const fs::path& path, std::string message, std::string hint = {}) {
  return {ErrorKind::kIo, std::move(message), {path.string(), 0, 0}, std::move(hint)};
}

template <class Container>
Result<Container> read_bytes(const fs::path& path, uint64_t max_size) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return io_error(path, "no such file", "check the path");
  if (fs::is_directory(status)) return io_error(path, "is a folder, not a file");
  if (!fs::is_regular_file(status)) return io_error(path, "is not a regular file");
  // From here on by the descriptor: another program may put a new file in the place of this one.
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0)
    return io_error(path, fmt::format("cannot open: {}", std::strerror(errno)),
                    "check its permissions");
  const std::unique_ptr<const int, void (*)(const int*)> closer(&fd,
                                                                [](const int* f) { ::close(*f); });
  struct stat found{};
  if (::fstat(fd, &found) != 0)
    return io_error(path, fmt::format("cannot read: {}", std::strerror(errno)));
  const auto size = static_cast<uint64_t>(found.st_size);
  if (size > max_size) {
    return io_error(
        path, fmt::format("has {} bytes; the limit for this kind of file is {}", size, max_size));
  }
  GLOAM_TRY_STATUS(check_memory(size, fmt::format("reading '{}'", path.string()),
                                "free some memory or use a smaller file"));
  Container bytes(size, 0);
  for (size_t done = 0; done < size;) {
    const ssize_t n = ::read(fd, bytes.data() + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return io_error(path, fmt::format("cannot read: {}", std::strerror(errno)));
    if (n == 0) return io_error(path, "ended while it was being read");
    done += static_cast<size_t>(n);
  }
  return bytes;
}

}  // namespace

std::string lower_extension(const fs::path& path) { return lower_case(path.extension().string()); }

Result<std::vector<uint8_t>> read_file(const fs::path& path, uint64_t max_size) {
  return read_bytes<std::vector<uint8_t>>(path, max_size);
}

Result<std::string> read_text_file(const fs::path& path, uint64_t max_size) {
  return read_bytes<std::string>(path, max_size);
}

Status write_file_atomic(const fs::path& path, std::span<const uint8_t> bytes) {
  // A name of this call's own: other threads, processes and machines may be writing the same file.
  std::string temporary;
  int fd = -1;
  std::random_device random;
  do {
    temporary = fmt::format("{}.{:08x}{}", path.string(), random(), kTemporaryEnding);
    fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  } while (fd < 0 && errno == EEXIST);
  if (fd < 0) {
    return io_error(path, fmt::format("cannot write: {}", std::strerror(errno)),
                    "check the folder and its permissions");
  }
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += static_cast<size_t>(n);
  }
  const int write_errno = errno;
  const bool closed = ::close(fd) == 0;
  if (done != bytes.size() || !closed) {
    const std::string cause = std::strerror(done != bytes.size() ? write_errno : errno);
    ::unlink(temporary.c_str());
    return io_error(path, fmt::format("cannot write: {}", cause),
                    "free some space or choose another folder");
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) {
    const std::string cause = std::strerror(errno);
    ::unlink(temporary.c_str());
    return io_error(path, fmt::format("cannot write: {}", cause));
  }
  return {};
}

Status write_text_file_atomic(const fs::path& path, const std::string& text) {
  return write_file_atomic(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

Status make_folder(const fs::path& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (code)
    return io_error(path, fmt::format("cannot create the folder: {}", code.message()),
                    "choose another with --out");
  if (!fs::is_directory(path, code))
    return io_error(path, "is a file, not a folder", "choose another with --out");
  return {};
}

Result<fs::path> gloam_home() {
  if (const char* home = std::getenv("GLOAM_HOME"); home != nullptr && *home != 0)
    return fs::path(home);
  std::error_code code;
  std::vector<fs::path> starts = {fs::read_symlink("/proc/self/exe", code)};
  Dl_info library{};  // of a program that uses the installed library, the one below is elsewhere
  if (::dladdr(reinterpret_cast<const void*>(&gloam_home), &library) != 0 &&
      library.dli_fname != nullptr) {
    starts.push_back(fs::canonical(library.dli_fname, code));
  }
  for (const fs::path& start : starts) {
    fs::path folder = start.parent_path();
    for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path()) {
      for (const fs::path& home : {folder, folder / "share" / "gloam"})  // source tree, installed
        if (fs::is_directory(home / "assets" / "robots", code)) return home;
    }
  }
  return Error{ErrorKind::kIo,
               "the folder 'assets' was not found above the program",
               {},
               "set GLOAM_HOME to Gloam's folder"};
}

}  // namespace gloam

#include "bridge/zmq/address_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>

namespace gloam::bridge::zeromq {
namespace {

Error file_error(const std::string& path, std::string_view what) {
  return {ErrorKind::kIo,
          fmt::format("'{}' {}", path, what),
          {},
          "set XDG_RUNTIME_DIR to a folder that you own and that has mode 700"};
}

// A folder that is ours alone; made if it is not there.
Status own_folder(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    return file_error(path, fmt::format("cannot be created: {}", std::strerror(errno)));
  struct stat about = {};
  if (lstat(path.c_str(), &about) != 0 || !S_ISDIR(about.st_mode))
    return file_error(path, "is not a folder");
  if (about.st_uid != geteuid()) return file_error(path, "belongs to another user");
  if ((about.st_mode & 077) != 0) return file_error(path, "is accessible by others");
  return {};
}

std::string folder_path() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime == '/') return std::string(runtime) + "/gloam";
  return fmt::format("/tmp/gloam-{}", geteuid());
}

std::string json_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      quoted += {'\\', c};
    else if (byte < 0x20)
      quoted += fmt::format("\\u{:04x}", byte);
    else
      quoted += c;
  }
  return quoted + "\"";
}

std::string as_json(const ServerAddress& address) {
  std::string json = "{";
  const auto add = [&json](std::string_view key, std::string_view value) {
    json += fmt::format("\"{}\": {}, ", key, json_text(value));
  };
  add("address", address.operations);
  add("streams", address.streams);
  add("token", address.token);
  add("public_key", address.public_key);
  add("scene", address.scene);
  add("machine", machine_id());
  return json + fmt::format("\"pid\": {}}}\n", getpid());
}

}  // namespace

std::string machine_id() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string boot;
  std::getline(file, boot);
  return boot.empty() ? std::string() : fmt::format("{}:{}", boot, geteuid());
}

Result<std::unique_ptr<AddressFile>> AddressFile::write(const ServerAddress& address) {
  const std::string folder = folder_path();
  GLOAM_TRY_STATUS(own_folder(folder));
  const std::string path = fmt::format("{}/zmq-{}.json", folder, address.port);
  const std::string draft = fmt::format("{}.{}", path, getpid());
  unlink(draft.c_str());
  const int fd = open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (fd < 0) return file_error(draft, fmt::format("cannot be written: {}", std::strerror(errno)));
  const std::string text = as_json(address);
  const bool is_written = ::write(fd, text.data(), text.size()) == std::ssize(text);
  close(fd);
  // The port is ours, so a file of this name is a dead server's.
  if (!is_written || std::rename(draft.c_str(), path.c_str()) != 0) {
    unlink(draft.c_str());
    return file_error(path, fmt::format("cannot be written: {}", std::strerror(errno)));
  }
  return std::unique_ptr<AddressFile>(new AddressFile(path));
}

AddressFile::~AddressFile() { unlink(path_.c_str()); }

}  // namespace gloam::bridge::zeromq

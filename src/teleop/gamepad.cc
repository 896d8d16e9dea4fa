#include "teleop/gamepad.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/joystick.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace gloam::teleop {
namespace {

constexpr int kDevices = 16;  // /dev/input/js0 …
constexpr size_t kMostBytes = 64 * sizeof(js_event);

struct Opened {
  int descriptor = -1;
  std::string name;
};

Error device_error(const std::string& device, const std::string& reason) {
  return {ErrorKind::kIo,
          fmt::format("cannot use '{}' as a gamepad: {}", device, reason),
          {},
          "gamepads are /dev/input/js0, js1 …; without --gamepad the first of them is used"};
}

Result<Opened> open_device(const std::string& device) {
  Opened opened{::open(device.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC), device};
  if (opened.descriptor < 0) return device_error(device, std::strerror(errno));
  struct stat status = {};
  std::array<char, 128> name = {};
  if (::fstat(opened.descriptor, &status) == 0 && S_ISFIFO(status.st_mode)) return opened;
  if (::ioctl(opened.descriptor, JSIOCGNAME(name.size() - 1), name.data()) < 0) {
    ::close(opened.descriptor);
    return device_error(device, "it is not a joystick");
  }
  opened.name = fmt::format("{} ({})", name.data(), device);
  return opened;
}

}  // namespace

Status Gamepad::open() {
  Result<Opened> opened = Opened{};
  if (!device_.empty()) opened = open_device(device_);
  for (int i = 0; device_.empty() && i < kDevices; ++i) {
    const std::string path = fmt::format("/dev/input/js{}", i);
    if (::access(path.c_str(), R_OK) != 0) continue;
    opened = open_device(path);
    if (opened.ok()) break;
  }
  if (!opened.ok()) return opened.error();
  descriptor_ = opened->descriptor;
  name_ = opened->name;
  return {};
}

void Gamepad::reopen(Time now) {
  if (descriptor_ >= 0 || (last_attempt_ && now - *last_attempt_ < kRetryPeriod)) return;
  last_attempt_ = now;
  static_cast<void>(open().ok());  // it is tried again
}

void Gamepad::read() {
  std::array<unsigned char, kMostBytes> bytes;
  const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
  if (count > 0) return events_.feed({bytes.data(), static_cast<size_t>(count)});
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  close();
}

void Gamepad::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  events_ = {};
}

std::optional<std::string> Gamepad::take_notice() {
  if (is_alive() == was_alive_) return {};
  was_alive_ = is_alive();
  if (was_alive_) return fmt::format("gamepad: {}", name_);
  return "the gamepad is unplugged, the robot stops; plug it in to resume";
}

}  // namespace gloam::teleop

#pragma once
// A gamepad that may be unplugged and plugged in at any time.

#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "teleop/gamepad_events.h"

namespace gloam::teleop {

class Gamepad {
 public:
  static constexpr std::chrono::seconds kRetryPeriod{1};

  /// `device`: as in TeleopOptions.
  explicit Gamepad(std::string device) : device_(std::move(device)) {}
  ~Gamepad() { close(); }
  Gamepad(const Gamepad&) = delete;
  Gamepad& operator=(const Gamepad&) = delete;

  /// Error: the named device does not open or is not a joystick.
  Status open();
  /// Tries again to open it, once per kRetryPeriod.
  void reopen(Time now);
  int descriptor() const { return descriptor_; }  ///< for poll(); -1 = there is none
  /// Reads the events that have arrived.
  void read();

  bool is_alive() const { return events_.is_alive(); }
  Deflection deflection() const { return events_.deflection(); }
  std::vector<Request> take_requests() { return events_.take_requests(); }
  /// Message that it has been plugged in or unplugged, since the last call.
  std::optional<std::string> take_notice();

 private:
  void close();

  const std::string device_;
  std::string name_;  // for display
  int descriptor_ = -1;
  GamepadEvents events_;
  bool was_alive_ = false;
  std::optional<Time> last_attempt_;
};

}  // namespace gloam::teleop

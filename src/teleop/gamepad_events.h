#pragma once
// Events of the Linux joystick API and their meaning for a gamepad with the axes
// and buttons of the kernel's driver xpad.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "teleop/inputs.h"

namespace gloam::teleop {

/// State of a gamepad. Bytes are not trusted: unknown types, axes and buttons are ignored, and an
/// event may arrive in pieces.
class GamepadEvents {
 public:
  void feed(std::span<const unsigned char> bytes);
  /// Whether an event of a known type has arrived.
  bool is_alive() const { return is_alive_; }
  /// Sticks and directional pad, without their dead zone. Zero after the stop button, until the
  /// sticks have returned to the centre.
  Deflection deflection() const;
  /// Requests of the buttons and triggers since the last call.
  std::vector<Request> take_requests();

 private:
  static constexpr size_t kAxisCount = 8;

  void take_event();
  void press(unsigned button);
  void set_axis(unsigned axis, double value);
  Deflection sticks() const;

  std::array<unsigned char, 8> event_ = {};
  size_t filled_ = 0;                         // bytes of event_
  std::array<double, kAxisCount> axes_ = {};  // -1 … 1
  std::vector<Request> requests_;
  bool is_alive_ = false, is_stopped_ = false;
};

}  // namespace gloam::teleop

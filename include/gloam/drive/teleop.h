#pragma once
// Teleoperation: drives a robot of a running Simulation from the keyboard of a terminal and from a
// gamepad (Linux joystick API). docs/controllers.md lists the keys, axes and buttons.

#include <memory>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/simulation.h"

namespace gloam {

struct TeleopOptions {
  std::string robot = {};  ///< empty = the first robot that accepts velocity or pose goals
  /// Device, such as "/dev/input/js0", or a FIFO; empty = the first of /dev/input/js0 to js15 that
  /// is plugged in, now or later.
  std::string gamepad = {};
  int keyboard = 0;  ///< file descriptor of the terminal; default: standard input
};

/// Posts ordinary Commands when the goal changes, so logs and replays contain the drive. Like the
/// bridges, it claims the robot with the first goal and releases it one second after the last.
class Teleop {
 public:
  /// Errors: no such robot, with the nearest name; no robot that can be driven; `keyboard` is not a
  /// terminal and no gamepad is named; the device is missing or is not a joystick.
  static Result<std::unique_ptr<Teleop>> start(Simulation& simulation,
                                               const TeleopOptions& options);
  /// Stops the robot and restores the terminal.
  virtual ~Teleop() = default;

  virtual std::vector<std::string> help() const = 0;  ///< lines of a table of keys
  /// Whether the user has requested it since the last call, or the keys have changed.
  virtual bool take_help_request() = 0;
  /// Goal, speed and devices at this moment, one line; the most important part first.
  virtual std::string status() const = 0;
  /// Messages since the last call: gamepads that come and go, rejected goals.
  virtual std::vector<std::string> take_notices() = 0;
  virtual bool end_asked() const = 0;  ///< the user has pressed Esc
};

/// Checks the options that do not depend on a robot, before a scene is compiled. Errors: as for
/// Teleop::start().
Status check_teleop(const TeleopOptions& options);

/// Returns the terminal of a Teleop to its state before it started, if there is one. Safe in signal
/// handlers, for programs that end without destroying their objects.
void restore_terminal() noexcept;

}  // namespace gloam

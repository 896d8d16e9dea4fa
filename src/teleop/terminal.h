#pragma once
// The terminal as a source of keys.

#include <termios.h>

#include <memory>
#include <vector>

#include "gloam/result.h"

namespace gloam::teleop {

/// Switches a terminal off line mode and echo, and restores it when it is destroyed, when the
/// process is suspended and before it ends by a fatal signal. Ctrl-C, Ctrl-Z and Ctrl-\ remain
/// signals. There is one at a time.
class Terminal {
 public:
  static Result<std::unique_ptr<Terminal>> open(int descriptor);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Whether keys can be read now; in the background they belong to other processes. Switches the
  /// terminal again after the process was suspended.
  bool is_ready();
  int descriptor() const { return descriptor_; }
  /// Returns the bytes that have arrived.
  std::vector<unsigned char> read();
  bool is_lost() const { return is_lost_; }  ///< the terminal has been closed

 private:
  explicit Terminal(int descriptor) : descriptor_(descriptor) {}

  const int descriptor_;
  bool is_lost_ = false;
};

/// Error: not a terminal.
Status check_terminal(int descriptor);

}  // namespace gloam::teleop

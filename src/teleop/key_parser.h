#pragma once
// Keys from the bytes that a terminal sends.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "teleop/inputs.h"

namespace gloam::teleop {

/// A key with its meaning; one of the members is set.
struct Key {
  Deflection move = {};              ///< one component of ±1
  Request request = Request::kNone;  ///< others than movements
  int speed = 0;                     ///< 1 … 9
};

/// Ignores keys without a meaning and escape sequences of other keys, of the mouse, of pastes.
class KeyParser {
 public:
  /// A lone escape character is the key Esc if nothing follows for this time.
  static constexpr std::chrono::milliseconds kEscapeTime{100};

  std::vector<Key> feed(std::span<const unsigned char> bytes, Time now);
  /// Returns the key Esc once its time has passed.
  std::optional<Key> check_escape(Time now);

 private:
  std::optional<Key> take(unsigned char byte);

  std::string sequence_;  // an escape sequence so far, at most kLongestSequence
  Time began_;
};

}  // namespace gloam::teleop

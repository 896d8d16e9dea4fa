#pragma once
// Keys that are held, as far as a terminal reports it: it repeats the last pressed key, and does
// not report releases.

#include <array>
#include <iterator>
#include <optional>

#include "teleop/inputs.h"

namespace gloam::teleop {

/// A movement lasts as long as its key repeats. Keys of different axes that are pressed while
/// another one repeats, or at the same time, move together until the last of them ends, because
/// only the last one repeats.
class HeldKeys {
 public:
  using Duration = Clock::duration;
  /// After the first press, until the first repeat has come for certain.
  static constexpr Duration kFirstHold = std::chrono::milliseconds(700);
  /// After a repeat: the slowest terminals repeat every 0.1 s.
  static constexpr Duration kRepeatHold = std::chrono::milliseconds(250);
  /// Time between two presses in which a key cannot have begun to repeat.
  static constexpr Duration kShortestDelay = std::chrono::milliseconds(200);
  /// Longest time since the last repeat of a key that counts as held.
  static constexpr Duration kTogether = std::chrono::milliseconds(120);

  /// `move` has one component of ±1.
  void press(const Deflection& move, Time now);
  void release_all() { axes_ = {}; }
  /// Whether a key that acts once per press has only been repeated.
  bool is_repeat(Request request, Time now);
  Deflection at(Time now) const;
  /// Time at which the next movement ends; empty = none is in force.
  std::optional<Time> next_end(Time now) const;

 private:
  struct Axis {
    double sign = 0;
    int presses = 0;  // in a row
    bool is_joined = false;
    Time last, end;
  };
  void hold(Axis* axis, double sign, Time now);

  std::array<Axis, std::size(kAxes)> axes_;
  Request last_request_ = Request::kNone;
  Time last_request_time_;
};

}  // namespace gloam::teleop

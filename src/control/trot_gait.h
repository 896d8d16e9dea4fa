#pragma once
// The clock of the trot: which feet should stand, and how far the others are through their swing.

#include <array>

namespace gloam {

/// Diagonal pairs alternate: front left + rear right, then front right + rear left (the order of
/// Quadruped::legs).
class TrotGait {
 public:
  TrotGait(double period, double duty) : period_(period), duty_(duty) {}

  void stand() { stepping_ = false; }
  /// Starts a stride; the second pair lifts first, after a moment with all feet down.
  void start();
  void advance(double dt);

  bool stepping() const { return stepping_; }
  double period() const { return period_; }
  double stance_time() const { return duty_ * period_; }
  double swing_time() const { return (1 - duty_) * period_; }

  bool should_stand(int leg) const { return !stepping_ || leg_phase(leg) < duty_; }
  /// 0 at lift-off, 1 at touch-down; only while !should_stand(leg).
  double swing_phase(int leg) const { return (leg_phase(leg) - duty_) / (1 - duty_); }
  /// All feet are meant to be down: the moment at which a stride may end.
  bool between_steps() const;

 private:
  double leg_phase(int leg) const;
  double period_, duty_, phase_ = 0;
  bool stepping_ = false;
};

}  // namespace gloam

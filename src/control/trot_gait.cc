#include "control/trot_gait.h"

#include <cmath>

namespace gloam {

void TrotGait::start() {
  stepping_ = true;
  phase_ = 0;
}

void TrotGait::advance(double dt) {
  if (!stepping_) return;
  phase_ += dt / period_;
  phase_ -= std::floor(phase_);
}

double TrotGait::leg_phase(int leg) const {
  const bool first_pair = leg == 0 || leg == 3;
  const double phase = phase_ + (first_pair ? 0 : 0.5);
  return phase - std::floor(phase);
}

bool TrotGait::between_steps() const {
  for (int leg = 0; leg < 4; ++leg)
    if (!should_stand(leg)) return false;
  return true;
}

}  // namespace gloam

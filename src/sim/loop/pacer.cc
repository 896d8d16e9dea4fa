#include "sim/loop/pacer.h"

#include <algorithm>
#include <thread>

namespace gloam {
namespace {
// Waking a thread costs about 50 µs, so steps shorter than this are taken in small bunches.
constexpr double kBatchTime = 1e-3;       // [s]
constexpr double kMaxSleep = 5e-3;        // [s]
constexpr double kLateThreshold = 10e-3;  // [s]
constexpr double kMaxCatchUp = 0.25;      // [s]
}  // namespace

void RealTimePacer::set_speed(double speed) {
  speed_ = speed;
  restart();
}

bool RealTimePacer::ready(int64_t step) {
  const Clock::time_point now = Clock::now();
  if (!anchored_) {
    anchored_ = true;
    anchor_ = now;
    anchor_step_ = step;
  }
  const double due = static_cast<double>(step - anchor_step_) * timestep_ / speed_;
  const double early = due - std::chrono::duration<double>(now - anchor_).count();
  if (early > kBatchTime) {
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(early, kMaxSleep)));
    return false;
  }
  if (-early > std::max(kLateThreshold, timestep_ / speed_)) ++missed_;
  if (-early > kMaxCatchUp) restart();
  return true;
}

}  // namespace gloam

#include "studio/picture_scale.h"

#include <algorithm>
#include <cmath>

namespace gloam::studio {
namespace {

constexpr int kMaxLevel = 4;           // a quarter of the width
constexpr double kMaxRetryDelay = 60;  // [s]

}  // namespace

double PictureScale::scale() const { return std::pow(0.5, 0.5 * level_); }

void PictureScale::add(double seconds, bool keeps_up) {
  if (seconds > kTargetInterval && !keeps_up) {
    // Time goes with the pixels: as many steps as bring it below the target.
    const int steps = static_cast<int>(std::ceil(std::log2(seconds / kTargetInterval)));
    if (climbed_) patience_ = std::min(2 * patience_, kMaxRetryDelay);
    level_ = std::min(level_ + std::max(steps, 1), kMaxLevel);
    good_ = 0;
    climbed_ = false;
    return;
  }
  good_ += seconds;
  if (level_ == 0 || good_ < patience_) return;
  --level_;
  good_ = 0;
  climbed_ = true;
}

}  // namespace gloam::studio

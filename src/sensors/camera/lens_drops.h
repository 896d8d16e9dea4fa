#pragma once
// Water drops on the glass in front of a lens, drawn over a finished picture: out of focus, upside
// down, and of a far wider view than what they hide. A pure function of (seed, time).

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "gloam/camera.h"

namespace gloam {

class LensDrops {
 public:
  /// They cover `share` of the picture in the mean, 0 … 1. `falling`: they come and go. `aperture`:
  /// radius of the lens's pupil [m], 0 = of a small camera.
  LensDrops(const Intrinsics& intrinsics, double share, bool falling, double aperture,
            uint64_t seed);

  /// `picture`: (height x width) at `time` [s].
  void draw(double time, std::vector<Vec3f>* picture) const;

 private:
  struct Drop {
    Vec2f center;      ///< [px]
    float radius = 0;  ///< [m]
    float there = 1;   ///< fraction of it that is there: it spreads, and is wiped away
  };
  Drop drop_at(int slot, double time) const;

  int width_, height_;
  float focal_;  ///< [px]
  float pupil_;  ///< radius [m]
  bool falling_;
  uint64_t seed_;
  int slots_ = 0;
};

}  // namespace gloam

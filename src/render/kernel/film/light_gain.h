#pragma once
// Factors that give a denoised picture the light that the noisy one had. Device-safe.

#include "base/vec.h"

namespace gloam {

inline constexpr int kWindowRadius = 32;      ///< of the windows that keep their light [px]
inline constexpr double kMostWindowGain = 8;  ///< of one pixel and channel
inline constexpr double kMostWholeGain = 2;   ///< of the picture, after that of its windows

GLOAM_HD float light_gain(double wanted, double found, double most) {
  if (!(found > 0)) return 1;
  const double gain = wanted / found;
  return static_cast<float>(gain < 1 / most ? 1 / most : (gain > most ? most : gain));
}
template <class F>
GLOAM_HD Vec3f light_gain(Vec3Of<F> wanted, Vec3Of<F> found, double most) {
  return {light_gain(wanted.x, found.x, most), light_gain(wanted.y, found.y, most),
          light_gain(wanted.z, found.z, most)};
}

}  // namespace gloam

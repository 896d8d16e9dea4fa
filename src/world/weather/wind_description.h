#pragma once
// The wind of a scene as numbers: how strong, whence, how gusty. sim/effects/wind/wind.h says what
// it is at an instant.

#include "gloam/scene.h"

namespace gloam {

struct WindDescription {
  double speed = 0;                 ///< mean 10 m above z = 0 [m/s]; 0 = the air is still
  double gusts = 0;                 ///< standard deviation along the wind [m/s]
  double along_x = 1, along_y = 0;  ///< unit, where it blows to
  uint64_t seed = 1;

  bool blows() const { return speed > 0; }
};

/// Wind blows where there is a sky: not in a generated building. `weather` has what its level of
/// adversity says already in it.
WindDescription describe_wind(const Scene& scene, const WeatherOptions& weather);

}  // namespace gloam

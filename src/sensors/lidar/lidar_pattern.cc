#include "sensors/lidar/lidar_pattern.h"

#include <cmath>

namespace gloam {

const LidarPattern& lidar_pattern(LidarPatternKind kind) {
  static constexpr LidarPattern kPatterns[] = {
      // In the order of LidarPatternKind.
      {fire_spinning, true, true},
      {fire_raster, true, true},
      {fire_flash, true, true},
      {fire_rosette, false, false},
  };
  return kPatterns[static_cast<size_t>(kind)];
}

Vec3f lidar_direction(double azimuth, double elevation) {
  return {static_cast<float>(std::cos(elevation) * std::cos(azimuth)),
          static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
          static_cast<float>(std::sin(elevation))};
}

}  // namespace gloam

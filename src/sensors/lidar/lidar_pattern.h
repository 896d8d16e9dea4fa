#pragma once
// Directions and times of a LiDAR's beams: one file for each kind of pattern.

#include <cstdint>
#include <vector>

#include "sensors/lidar/lidar_model.h"

namespace gloam {

struct LidarFiring {
  Vec3f d;         ///< unit, in the sensor's frame: x ahead, y to the left, z up
  float time = 0;  ///< 0 … 1 of the scan
  uint16_t ring = 0, column = 0;
};

struct LidarPattern {
  /// The beams of one scan in the order of their firing.
  std::vector<LidarFiring> (*fire)(const LidarModel& model, int64_t scan);
  bool repeats = true;  ///< every scan has the same beams
  bool grid = true;     ///< rings and columns make a range image
};
const LidarPattern& lidar_pattern(LidarPatternKind kind);

std::vector<LidarFiring> fire_spinning(const LidarModel& model, int64_t scan);
std::vector<LidarFiring> fire_raster(const LidarModel& model, int64_t scan);
std::vector<LidarFiring> fire_flash(const LidarModel& model, int64_t scan);
std::vector<LidarFiring> fire_rosette(const LidarModel& model, int64_t scan);

/// Unit direction at an azimuth (counter-clockwise from ahead) and an elevation [rad].
Vec3f lidar_direction(double azimuth, double elevation);

}  // namespace gloam

#pragma once
// One LiDAR in numbers: its preset with what the scene says otherwise.

#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/lidar.h"
#include "render/kernel/lidar/lidar_detect.h"

namespace gloam {

enum class LidarPatternKind : uint8_t { kSpinning, kRaster, kFlash, kRosette };  // kLidarPatterns

struct LidarModel {
  LidarPatternKind pattern = LidarPatternKind::kSpinning;
  Rational rate = {10, 1};  ///< scans per second
  // Spinning.
  std::vector<float> elevations;  ///< elevations of the rings, from below [rad]
  std::vector<float> delays;  ///< delay of each ring's firing within its column [s]; empty = none
  int columns = 1024;         ///< columns of a whole turn; of a grid
  bool clockwise = true;      ///< seen from above
  float azimuth_from = -kPi, azimuth_to = kPi;  ///< counter-clockwise from ahead [rad]
  // Grids and rosettes.
  int rows = 0;
  float width = 0, height = 0;  ///< field of view [rad]
  int points = 0;               ///< points of a rosette's scan
  double prism_hz[2] = {};      ///< revolutions of its prisms per second
  LidarOptics optics;
};

/// Errors: numbers that contradict each other, a grid without its numbers.
Result<LidarModel> make_lidar_model(const LidarOptions& options);

}  // namespace gloam

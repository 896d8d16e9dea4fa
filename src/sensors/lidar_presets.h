#pragma once
// LiDARs after their published data sheets: docs/lidar.md says which number is from where.

#include <string_view>

#include "sensors/lidar_model.h"

namespace gloam {

struct LidarPreset {
  std::string_view name;
  LidarModel (*make)();
};

/// Approximate where a sheet is silent or a unit has its own calibration: rings and beam of the
/// HDL-64E, beams of the VLP-16 and the HDL-32E, which the same page says.
/// Null where there is none of that name.
const LidarPreset* find_lidar_preset(std::string_view name);

/// Least signal of a receiver that just detects a plate of 10 % reflectance at `range` [m]; 0 = 0.
float lidar_threshold(double range);

}  // namespace gloam

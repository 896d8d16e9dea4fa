#pragma once
// LiDARs after their published data sheets: docs/lidar.md says which number is from where.

#include <string_view>

#include "sensors/lidar/lidar_model.h"

namespace gloam {

struct LidarPreset {
  std::string_view name;
  LidarModel (*make)();
};

/// Null where there is none of that name. What is approximate in them the same page says.
const LidarPreset* find_lidar_preset(std::string_view name);

/// Least signal of a receiver that just detects a plate of 10 % reflectance at `range` [m]; 0 = 0.
float lidar_threshold(double range);

}  // namespace gloam

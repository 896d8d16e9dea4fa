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

/// Offset [m] of a beam from the axis of a receiver beside it: a quarter of the beam's width beyond
/// the rim of the receiver's lens, since lenses are cut where they meet. With it a VLP-16 and an
/// HDL-64E range fog itself below a visibility of some 50 m (Bijelic, Gruber and Ritter 2018, "A
/// benchmark for lidar sensors in fog: is detection breaking down?").
float offset_of_lenses(const LidarOptics& optics);

/// Least signal of a receiver that just detects a plate of 10 % reflectance at `range` [m]; 0 = 0.
float lidar_threshold(double range);

}  // namespace gloam

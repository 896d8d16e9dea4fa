#pragma once
// Outputs of sensors as small pictures for people, side by side.

#include <cstdint>
#include <vector>

#include "gloam/camera.h"
#include "gloam/sensor.h"

namespace gloam {

/// All are sRGB, (height x width x 3).
using Panel = std::vector<uint8_t>;

/// From white, near, over blue to black at `far` [m]; what was not measured (0, infinite) is grey.
Panel depth_panel(const std::vector<float>& depth, float far);

/// From black at `cold` to white at `hot` [K], over violet and orange.
Panel thermal_panel(const std::vector<float>& kelvin, float cold, float hot);

/// First returns from above, ahead is up; the LiDAR stands in the middle, sides are `reach` [m]
/// away. Surfaces are white; with the scan's truth, returns of media are orange.
Panel lidar_panel(const LidarScan& scan, int width, int height, float reach);

}  // namespace gloam

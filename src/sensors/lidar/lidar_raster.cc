// Solid-state scanners: a grid of even angles, from the left to the right column by column, or all
// at once.

#include "sensors/lidar/lidar_pattern.h"

namespace gloam {
namespace {

std::vector<LidarFiring> fire_grid(const LidarModel& model, bool at_once) {
  const int beams = model.rows * model.columns;
  std::vector<LidarFiring> firings;
  firings.reserve(static_cast<size_t>(beams));
  for (int column = 0; column < model.columns; ++column) {
    for (int row = 0; row < model.rows; ++row) {
      LidarFiring firing;
      firing.d = lidar_direction(model.width * (0.5 - (column + 0.5) / model.columns),
                                 model.height * ((row + 0.5) / model.rows - 0.5));
      if (!at_once) firing.time = static_cast<float>(firings.size()) / static_cast<float>(beams);
      firing.ring = static_cast<uint16_t>(row);
      firing.column = static_cast<uint16_t>(column);
      firings.push_back(firing);
    }
  }
  return firings;
}

}  // namespace

std::vector<LidarFiring> fire_raster(const LidarModel& model, int64_t) {
  return fire_grid(model, false);
}
std::vector<LidarFiring> fire_flash(const LidarModel& model, int64_t) {
  return fire_grid(model, true);
}

}  // namespace gloam

// A column of lasers that turns about the sensor's z axis. A scan begins behind the sensor; the
// head goes on turning while the lasers of a column fire one after the other.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sensors/lidar/lidar_pattern.h"

namespace gloam {

std::vector<LidarFiring> fire_spinning(const LidarModel& model, int64_t) {
  const size_t rings = model.elevations.size();
  std::vector<size_t> order(rings);  // order of firing
  std::iota(order.begin(), order.end(), size_t{0});
  if (!model.delays.empty()) {
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return model.delays[a] < model.delays[b]; });
  }
  const double turn = (model.clockwise ? -2 : 2) * M_PI;
  std::vector<LidarFiring> firings;
  firings.reserve(rings * static_cast<size_t>(model.columns));
  for (int column = 0; column < model.columns; ++column) {
    const double begin = static_cast<double>(column) / model.columns;  // fraction of a turn
    const double azimuth = std::remainder(M_PI + turn * begin, 2 * M_PI);
    constexpr double kRounding = 1e-6;
    if (azimuth < model.azimuth_from - kRounding || azimuth > model.azimuth_to + kRounding)
      continue;
    for (const size_t ring : order) {
      const double late = model.delays.empty() ? 0 : model.delays[ring] * model.rate.value();
      LidarFiring firing;
      firing.d = lidar_direction(azimuth + turn * late, model.elevations[ring]);
      firing.time = static_cast<float>(std::min(begin + late, 1.0));
      firing.ring = static_cast<uint16_t>(ring);
      firing.column = static_cast<uint16_t>(column);
      firings.push_back(firing);
    }
  }
  return firings;
}

}  // namespace gloam

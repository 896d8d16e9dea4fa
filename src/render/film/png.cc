#include "render/film/png.h"

#include <algorithm>
#include <cmath>

namespace gloam {

std::vector<uint16_t> depth_to_millimetres(std::span<const float> depth) {
  std::vector<uint16_t> out(depth.size());
  for (size_t i = 0; i < depth.size(); ++i) {
    const double mm = std::round(1000.0 * static_cast<double>(depth[i]));
    out[i] = mm >= 1 && mm <= 65535 ? static_cast<uint16_t>(mm) : uint16_t{0};
  }
  return out;
}

std::vector<uint16_t> to_centikelvins(std::span<const float> temperature) {
  std::vector<uint16_t> out(temperature.size());
  for (size_t i = 0; i < temperature.size(); ++i) {
    const double value = std::round(100.0 * static_cast<double>(temperature[i]));
    out[i] = static_cast<uint16_t>(std::clamp(value, 0.0, 65535.0));
  }
  return out;
}

}  // namespace gloam

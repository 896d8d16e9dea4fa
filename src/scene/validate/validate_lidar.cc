#include "scene/validate/validate_lidar.h"

#include <fmt/format.h>

namespace gloam {

Status validate_lidar(const LidarOptions& lidar) {
  const auto bad = [&](const std::string& what, std::string hint) {
    return Error{ErrorKind::kInput, fmt::format("lidar '{}' {}", lidar.name, what), lidar.loc,
                 std::move(hint)};
  };
  if (lidar.wavelength && *lidar.wavelength != 905 && *lidar.wavelength != 1550) {
    return bad(fmt::format("has a wavelength of {} nm", *lidar.wavelength),
               "media and materials support only 905 and 1550");
  }
  if (lidar.min_range && lidar.max_range && !(*lidar.min_range < *lidar.max_range)) {
    return bad(fmt::format("has a range from {} m to {} m", *lidar.min_range, *lidar.max_range),
               "'max_range' must be greater than 'min_range'");
  }
  if (lidar.azimuth && !((*lidar.azimuth)[0] < (*lidar.azimuth)[1])) {
    return bad(fmt::format("scans from {} to {} degrees", (*lidar.azimuth)[0], (*lidar.azimuth)[1]),
               "'azimuth' must be [from, to] with from < to");
  }
  constexpr size_t kMostRings = 4096;
  if (lidar.elevations && (lidar.elevations->empty() || lidar.elevations->size() > kMostRings)) {
    return bad(fmt::format("has {} rings", lidar.elevations->size()),
               fmt::format("'elevations' must contain 1 to {} angles", kMostRings));
  }
  return {};
}

}  // namespace gloam

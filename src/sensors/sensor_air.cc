#include "sensors/sensor_air.h"

#include <cmath>

namespace gloam {

Result<SensorAir> SensorAir::make(const RenderDescription& description) {
  SensorAir air;
  std::vector<MediumDescription> media = description.media;
  // Emission of light, which no sensor uses
  for (MediumDescription& medium : media) medium.emission = 0;
  GLOAM_TRY(air.volumes_, VolumeStore::make(media, description.volumes));
  return air;
}

bool crosses(const VolumeView& volume, Vec3f origin_G, Vec3f direction_G, double* near,
             double* far) {
  double t0 = 0, t1 = std::numeric_limits<double>::infinity();
  const float ends[3] = {static_cast<float>(volume.nx), static_cast<float>(volume.ny),
                         static_cast<float>(volume.nz)};
  for (int axis = 0; axis < 3; ++axis) {
    const double o = double{origin_G[axis]}, d = double{direction_G[axis]};
    if (std::abs(d) < 1e-12) {
      if (o < 0 || o > double{ends[axis]}) return false;
      continue;
    }
    const double a = -o / d, b = (double{ends[axis]} - o) / d;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  *near = t0;
  *far = t1;
  return t0 < t1;
}

}  // namespace gloam

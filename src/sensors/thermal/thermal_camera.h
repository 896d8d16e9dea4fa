#pragma once
// An approximate thermal camera: every thing has one temperature and one emissivity, what it does
// not emit it reflects of surroundings of one temperature, and volumes emit and absorb in their own
// band of 8 … 14 µm on the way. No heat flows and nothing mirrors anything else.

#include <cstdint>
#include <vector>

#include "gloam/scene/sensor.h"
#include "render/film/film.h"
#include "render/renderer.h"
#include "sensors/sensor_air.h"
#include "world/render_description.h"

namespace gloam {

class ThermalCamera {
 public:
  /// Temperatures where no [[temperature]] fits, and for rays that hit nothing (a body named
  /// "sky"): 293.15 K, emissivity 0.95. Error: a [[temperature]] that fits nothing.
  static Result<ThermalCamera> make(const ThermalOptions& options,
                                    const std::vector<TemperatureOptions>& temperatures,
                                    const RenderDescription& description, uint64_t seed);

  /// Apparent temperatures [K], (height x width), from exact channels: those of black bodies that
  /// would send as much. Noise is normal in radiance (NETD: standard deviation as a difference of
  /// temperature at 300 K), keyed (seed, frame, pixel); the fixed pattern is each pixel's own.
  std::vector<float> see(const Film& film, const CameraView& view, int64_t frame,
                         const MediaView& media) const;

 private:
  ThermalCamera(const ThermalOptions& options, uint64_t seed) : options_(options), seed_(seed) {}

  ThermalOptions options_;
  uint64_t seed_;
  std::vector<double> radiance_;  // radiance by part; 0 = the sky [W/(m² sr)]
};

}  // namespace gloam

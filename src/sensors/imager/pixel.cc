#include "sensors/imager/pixel.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sensors/signal/draw.h"

namespace gloam {
namespace {

// Photons of 555 nm per m² of 1 lx s: 1 / (683 lm/W) over h c / lambda.
constexpr double kPhotonsPerLuxSecond = 1 / 683.0 / 3.5792e-19;
constexpr double kLensFactor = 0.65;  // q of ISO 12232: H = q L t / N²
constexpr double kSaturation = 78;    // [lx s] times the speed: H at the top of the scale

// One fixed number per site.
std::vector<float> pattern(size_t sites, uint64_t seed, uint32_t stream, double mean,
                           double spread) {
  std::vector<float> out;
  if (spread <= 0) return out;
  out.resize(sites);
  const RandomStream draws{seed, stream};
  parallel_for_range("fixed_pattern", static_cast<int64_t>(sites), 4096,
                     [&](int64_t begin, int64_t end) {
                       for (int64_t i = begin; i < end; ++i) {
                         const double x = draw_normal(draws, 0, static_cast<uint32_t>(i));
                         out[static_cast<size_t>(i)] = static_cast<float>(mean + spread * x);
                       }
                     });
  return out;
}

}  // namespace

PixelArray::PixelArray(const PixelOptions& options, size_t sites, uint64_t seed)
    : options_(options),
      seed_(seed),
      quantised_(options.bits > 0 ? 1 : 0),
      top_(options.bits > 0 ? std::exp2(options.bits) - 1 : 1),
      gain_(pattern(sites, seed, stream_id("imager.prnu"), 1, options.prnu)),
      offset_(pattern(sites, seed, stream_id("imager.dsnu"), 0, options.dsnu)) {}

PixelArray::Gains PixelArray::gains(const Exposure& exposure) const {
  const double area = options_.pitch * options_.pitch * 1e-12;  // [m²]
  const double electrons_per_lux_second = options_.quantum_efficiency * area * kPhotonsPerLuxSecond;
  Gains gains;
  gains.electrons_per_light = electrons_per_lux_second * kLensFactor * exposure.shutter /
                              (exposure.f_number * exposure.f_number);
  gains.dark_electrons = options_.dark_current * exposure.shutter;
  gains.numbers_per_electron = (top_ - options_.black_level * quantised_) /
                               (electrons_per_lux_second * kSaturation / exposure.iso);
  return gains;
}

double PixelArray::read(const Gains& gains, double light, uint64_t frame, size_t i) const {
  const auto site = static_cast<uint32_t>(i);
  // Infinite light fills the pixel; what is no number is dark.
  const double bright = light > 0 ? std::min(light * gains.electrons_per_light, 1e8) : 0;
  const double mean =
      bright * (gain_.empty() ? 1 : static_cast<double>(gain_[i])) + gains.dark_electrons;
  double electrons = mean;
  if (options_.shot_noise)
    electrons = draw_poisson({seed_, stream_id("imager.shot")}, frame, site, mean);
  electrons = std::min(electrons, options_.full_well);
  if (options_.read_noise > 0)
    electrons += options_.read_noise * draw_normal({seed_, stream_id("imager.read")}, frame, site);
  if (!offset_.empty()) electrons += static_cast<double>(offset_[i]);
  const double reading = electrons * gains.numbers_per_electron;
  if (quantised_ == 0) return std::min(reading, top_);
  return std::clamp(std::round(reading + options_.black_level), 0.0, top_);
}

}  // namespace gloam

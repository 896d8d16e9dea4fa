#include "world/effects/water_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/rng.h"

namespace gloam {
namespace {

constexpr double kGravity = 9.81;  // [m/s²]
constexpr double kPi2 = 2 * std::numbers::pi;
constexpr int kWaveCount = 40;
// Range of frequencies over that of the strongest waves: 0.2 % of the energy lies below it and 0.2
// % above.
constexpr double kLongest = 0.6, kShortest = 5;
constexpr double kPeakedness = 3.3;  // JONSWAP's mean gamma

constexpr double kRippleLength = 1;       // wave length whose speed ripples have [m]
constexpr double kFinestCell = 0.04;      // finest cell of ripples [m]
constexpr double kCoarsestCell = 0.25;    // beyond which bodies are lost between cells [m]
constexpr double kMostRippleCells = 192;  // along an edge
constexpr Rational kRippleRate{60, 1};
constexpr double kMostMeshCells = 6e4;

Error water_error(const WaterOptions& o, std::string message, std::string hint) {
  return {ErrorKind::kInput, fmt::format("water '{}': {}", o.name, message), o.loc,
          std::move(hint)};
}

/// Wave number of a frequency: omega² = g k tanh(k depth), by Newton's method from deep or shallow
/// water's.
double wave_number(double omega, double depth) {
  const double deep = omega * omega / kGravity;
  double k = std::max(deep, omega / std::sqrt(kGravity * depth));
  for (int i = 0; i < 20; ++i) {
    const double t = std::tanh(k * depth);
    const double f = k * t - deep, slope = t + k * depth * (1 - t * t);
    k -= f / slope;
  }
  return k;
}

/// JONSWAP's spectrum of frequencies relative to the strongest (Hasselmann et al. 1973), up to a
/// factor.
double jonswap(double r) {
  const double width = r <= 1 ? 0.07 : 0.09;
  const double peak = std::exp(-(r - 1) * (r - 1) / (2 * width * width));
  return std::pow(r, -5) * std::exp(-1.25 * std::pow(r, -4)) * std::pow(kPeakedness, peak);
}

double normal(const RandomStream& random, uint64_t i, uint32_t index) {
  const double u = 1 - random.uniform(i, index), v = random.uniform(i, index + 1);
  return std::sqrt(-2 * std::log(u)) * std::cos(kPi2 * v);
}

std::vector<WaveDescription> make_waves(const WaterOptions& o, uint64_t seed) {
  if (o.wave_height == 0) return {};
  const RandomStream random{seed, stream_id(o.name.c_str()) ^ stream_id("water.waves")};
  const double ratio = std::pow(kShortest / kLongest, 1.0 / kWaveCount);
  std::vector<WaveDescription> waves;
  double low = kLongest, energy = 0;
  for (uint32_t i = 0; i < kWaveCount; ++i, low *= ratio) {
    // Simpson's rule over the band; the wave stands anywhere in it.
    const double high = low * ratio;
    const double share =
        (jonswap(low) + 4 * jonswap((low + high) / 2) + jonswap(high)) * (high - low) / 6;
    const double frequency = low * std::pow(ratio, random.uniform(i, 0));
    const double direction = (o.wave_to + o.spread * normal(random, i, 1)) * kPi2 / 360;
    WaveDescription wave;
    wave.omega = kPi2 * frequency / o.wave_period;
    const double k = wave_number(wave.omega, o.depth);
    wave.kx = k * std::cos(direction);
    wave.ky = k * std::sin(direction);
    wave.phase = kPi2 * random.uniform(i, 3);
    wave.amplitude = std::sqrt(2 * share);
    energy += share;
    waves.push_back(wave);
  }
  // Significant height is four standard deviations (Longuet-Higgins 1952).
  for (WaveDescription& wave : waves) wave.amplitude *= o.wave_height / 4 / std::sqrt(energy);
  return waves;
}

/// Mean square slope of the ripples that wind makes on top of the waves. Cox and Munk 1954,
/// "Measurement of the roughness of the sea surface from photographs of the sun's glitter": of a
/// clean surface 0.003 + 0.00512 U in all, U = the wind [m/s] at 12.5 m. Without wind there are
/// none.
double slopes_of_ripples(double wind, const std::vector<WaveDescription>& waves) {
  if (wind == 0) return 0;
  double of_waves = 0;
  for (const WaveDescription& wave : waves)
    of_waves += wave.amplitude * wave.amplitude * wave.k() * wave.k() / 2;
  return std::max(0.003 + 0.00512 * wind - of_waves, 0.0);
}

WaterGrid grid_of(const WaterOptions& o, double cell) {
  const auto along = [cell](double edge) { return std::max(static_cast<int>(edge / cell), 4); };
  WaterGrid grid{along(o.size[0]), along(o.size[1]), 0, 0};
  grid.dx = o.size[0] / grid.nx;
  grid.dy = o.size[1] / grid.ny;
  return grid;
}

/// As fine as the shortest waves and ripples need it, or as many cells as are drawn.
WaterGrid mesh_of(const WaterOptions& o, const WaterDescription& water) {
  double cell = std::max(o.size[0], o.size[1]);
  if (water.waves.empty() && water.ripples.nx == 0) return {1, 1, o.size[0], o.size[1]};
  for (const WaveDescription& wave : water.waves) cell = std::min(cell, kPi2 / wave.k() / 8);
  if (water.ripples.nx > 0) cell = std::min(cell, std::min(water.ripples.dx, water.ripples.dy));
  return grid_of(o, std::max(cell, std::sqrt(o.size[0] * o.size[1] / kMostMeshCells)));
}

/// Waves break where crests get steeper than 0.142 tanh(k depth) (Miche 1944): 1/7 in deep water.
Status check_waves(const WaterOptions& o) {
  const double k = wave_number(kPi2 / o.wave_period, o.depth);
  const double length = kPi2 / k;
  const double highest = 0.142 * length * std::tanh(k * o.depth);
  if (o.wave_height <= highest) return {};
  return water_error(o,
                     fmt::format("waves of {:g} m and {:g} s are {:.2f} m long here and would "
                                 "break: the maximum height is {:.3g} m",
                                 o.wave_height, o.wave_period, length, highest),
                     "reduce 'wave_height', or increase 'wave_period' or 'depth'");
}

bool overlap(const WaterOptions& a, const WaterOptions& b) {
  const auto apart = [](double p, double half_p, double q, double half_q) {
    constexpr double kEdgeTolerance = 1e-6;  // tolerance of edges that meet [m]
    return std::abs(p - q) >= half_p + half_q - kEdgeTolerance;
  };
  return !apart(a.position.x, a.size[0] / 2, b.position.x, b.size[0] / 2) &&
         !apart(a.position.y, a.size[1] / 2, b.position.y, b.size[1] / 2) &&
         !apart(a.position.z - a.depth / 2, a.depth / 2, b.position.z - b.depth / 2, b.depth / 2);
}

WaterDescription describe_water(const WaterOptions& o, double wind, uint64_t seed) {
  WaterDescription water;
  water.name = o.name;
  water.x = o.position.x, water.y = o.position.y, water.level = o.position.z;
  water.size_x = o.size[0], water.size_y = o.size[1], water.depth = o.depth;
  water.density = o.density;
  water.viscosity = o.viscosity;
  water.current = o.current;
  water.clarity = o.clarity;
  water.loc = o.loc;
  water.waves = make_waves(o, seed);
  water.short_slopes = slopes_of_ripples(wind, water.waves);
  const double cell = std::max(kFinestCell, std::max(o.size[0], o.size[1]) / kMostRippleCells);
  if (o.ripples && cell <= kCoarsestCell) water.ripples = grid_of(o, cell);
  water.ripple_rate = kRippleRate;
  const double k = kPi2 / kRippleLength;
  water.ripple_speed = std::sqrt(kGravity / k * std::tanh(k * o.depth));
  water.mesh = mesh_of(o, water);
  return water;
}

}  // namespace

double WaveDescription::k() const { return std::hypot(kx, ky); }

Result<std::vector<WaterDescription>> describe_waters(const Scene& scene) {
  const double wind = scene.weather ? scene.weather->wind.value_or(0) : 0;
  std::vector<WaterDescription> waters;
  for (size_t i = 0; i < scene.waters.size(); ++i) {
    const WaterOptions& o = scene.waters[i];
    GLOAM_TRY_STATUS(check_waves(o));
    for (size_t other = 0; other < i; ++other) {
      if (!overlap(o, scene.waters[other])) continue;
      return water_error(
          o, fmt::format("its box overlaps the box of water '{}'", scene.waters[other].name),
          "merge them into one box, or move them apart");
    }
    waters.push_back(describe_water(o, wind, scene.sim.seed));
  }
  return waters;
}

}  // namespace gloam

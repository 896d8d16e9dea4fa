// When plumes begin: the front of a starting plume is compared with Turner's law (1962),
// z^(4/3) = c t with c = 3.8 B^(1/3), where B is the flux of buoyancy; the mean lag of time between
// 0.8 and 2.5 m is the delay. A source of the radius R has the time scale (R⁴ / B)^(1/3). For one
// radius the delay must be the same multiple of it for all powers, which a delay of the program, of
// a tick or of half a second, would not be.
//
// The multiple itself is not derived. A ball whose buoyancy grows as B t, with the added mass of a
// sphere, rises by its radius in (12 pi)^(1/3) = 3.4 time scales, which is its order of magnitude.
//
// Turner's law is one of small differences of density. It holds while a source heats its own air by
// a small share of its absolute temperature within one time scale: 0.08 or less in these tests. A
// ball of 0.15 m with 20 kW reaches 0.39; its front rises at 0.75 c and lags by 5.7 time scales.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gas_room.h"

namespace gloam {
namespace {

/// B, the flux of buoyancy of a heat of `power` [kW] [m⁴/s³].
double buoyancy(double power) { return 9.81 * power * 1e3 / (1.204 * 1005 * 293); }

/// Height up to which some air is warmer by a tenth of the axis of a steady plume there [m].
double front_of(const GasSolver& gas, double power) {
  const GasGrid& grid = gas.grid();
  std::vector<float> soot, kelvin;
  gas.read(&soot, &kelvin);
  const size_t plane = size_t(grid.nx) * size_t(grid.ny);
  for (size_t k = size_t(grid.nz); k-- > 0;) {
    const auto layer = kelvin.begin() + ptrdiff_t(k * plane);
    const double warmest = double(*std::max_element(layer, layer + ptrdiff_t(plane))) - 293;
    const double z = (double(k) + 0.5) * double(grid.voxel);
    if (warmest > 2.5 * std::pow(power, 2.0 / 3) * std::pow(z, -5.0 / 3))
      return double(k + 1) * double(grid.voxel);
  }
  return 0;
}

/// A starting plume against Turner's law.
struct Start {
  double lag;   ///< of its front, mean between 0.8 and 2.5 m above the source's middle [s]
  double rate;  ///< of z^(4/3) there, as a fraction of c
};

/// A plume of `power` [kW] from a ball of the radius `size` [m].
Start start_of(double power, double size) {
  constexpr float kVoxel = 0.1f;
  const auto cells = [](float length) { return int(std::round(length / kVoxel)); };
  GasProperties p;
  p.open[4] = false;
  p.cooling = 0;
  auto gas = make_gas({cells(3.2f), cells(3.2f), cells(6), kVoxel, {-1.6f, -1.6f, 0}}, p);
  GasSource source = ball({0, 0, float(size)}, float(size));
  source.heat = float(power) * 1e3f;
  const double c = 3.8 * std::cbrt(buoyancy(power));
  double n = 0, lag = 0, x = 0, t = 0, xx = 0, xt = 0;  // sums for a line through t (z^(4/3))
  for (int i = 1; i <= 200; ++i) {
    gas->step(0.05f, std::span(&source, 1), {});
    const double z = front_of(*gas, power) - size;  // from the middle of the source
    if (z > 2.5) break;
    if (z < 0.8) continue;
    const double time = 0.05 * i, way = std::pow(z, 4.0 / 3);
    lag += time - way / c;
    n += 1, x += way, t += time, xx += way * way, xt += way * time;
  }
  return {lag / n, (n * xx - x * x) / (n * xt - x * t) / c};
}

double time_scale(double power, double size) {
  return std::cbrt(std::pow(size, 4) / buoyancy(power));
}

TEST(GasPlumes, OfOneSizeBeginAfterAMultipleOfTheirTimeScale) {
  constexpr double kSize = 0.4;  // [m]
  for (const double power : {5.0, 20.0, 60.0}) {
    const double scales = start_of(power, kSize).lag / time_scale(power, kSize);
    std::printf("%.0f kW: the front lags by %.2f (R^4/B)^(1/3)\n", power, scales);
    EXPECT_NEAR(scales, 3.4, 0.6) << power << " kW";
  }
}

// At five radii and more above its source, a plume has forgotten the source's size.
TEST(GasPlumes, OfSmallSourcesRiseAsTurnersLawStates) {
  constexpr double kSize = 0.15;  // [m]
  for (const double power : {0.5, 2.0}) {
    const Start start = start_of(power, kSize);
    const double scales = start.lag / time_scale(power, kSize);
    std::printf("%.1f kW: rises at %.2f c and lags by %.2f (R^4/B)^(1/3)\n", power, start.rate,
                scales);
    EXPECT_NEAR(start.rate, 1, 0.1) << power << " kW";
    EXPECT_NEAR(scales, 4.4, 0.6) << power << " kW";
  }
}

}  // namespace
}  // namespace gloam

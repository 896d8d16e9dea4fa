// When plumes begin: the front of a starting plume follows Turner's law (1962), z^(4/3) = c t, from
// the moment at which its source has lifted the air that it heats. A source of the radius R and the
// flux of buoyancy B has one time scale, (R⁴ / B)^(1/3), so the delay is a multiple of it, the same
// for all powers. A delay of the program, of a tick or of half a second, would not be.
//
// A ball whose buoyancy grows as B t accelerates its own mass and the added mass of a sphere, half
// of it: z = B t³ / (9 V). It has risen by its radius after (12 pi)^(1/3) = 3.4 of that time scale.

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

/// When a plume of `power` [kW] from a ball of the radius `size` [m] begins, by the heights of its
/// front and the speed of Turner's law [s].
double begin_of(double power, double size, float voxel) {
  const auto cells = [voxel](float length) { return int(std::round(length / voxel)); };
  GasProperties p;
  p.open[4] = false;
  p.cooling = 0;
  auto gas = make_gas({cells(3.2f), cells(3.2f), cells(6), voxel, {-1.6f, -1.6f, 0}}, p);
  GasSource source = ball({0, 0, float(size)}, float(size));
  source.heat = float(power) * 1e3f;
  const double c = 3.8 * std::cbrt(buoyancy(power));
  double n = 0, sum = 0;
  for (int i = 1; i <= 80; ++i) {
    gas->step(0.05f, std::span(&source, 1), {});
    const double z = front_of(*gas, power) - size;  // from the middle of the source
    if (z < 0.8 || z > 2.5) continue;
    sum += 0.05 * i - std::pow(z, 4.0 / 3) / c;
    n += 1;
  }
  return sum / n;
}

TEST(GasPlumes, BeginOnceTheirSourceHasLiftedItsAir) {
  constexpr double kSize = 0.4;  // [m]
  for (const double power : {5.0, 20.0, 60.0}) {
    const double begin = begin_of(power, kSize, 0.1f);
    const double scale = std::cbrt(std::pow(kSize, 4) / buoyancy(power));
    std::printf("%.0f kW: begins at %.2f s, %.2f (R^4/B)^(1/3)\n", power, begin, begin / scale);
    EXPECT_NEAR(begin / scale, 3.4, 0.6) << power << " kW";
  }
}

}  // namespace
}  // namespace gloam

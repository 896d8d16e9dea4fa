// When plumes begin: the front of one that starts against Turner's law with a virtual origin in
// time, and against how long a source of its size takes to lift its own air.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gas_room.h"

namespace gloam {
namespace {

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

struct Start {
  double speed = 0;  ///< c of z^(4/3) = c (t - late) [m^(4/3)/s]
  double late = 0;   ///< [s]
};

/// Line through the fronts of a plume of `power` [kW] from a ball of the radius `size` [m].
Start start_of(double power, double size, float voxel) {
  const auto cells = [voxel](float length) { return int(std::round(length / voxel)); };
  GasProperties p;
  p.open[4] = false;
  p.cooling = 0;
  auto gas = make_gas({cells(3.2f), cells(3.2f), cells(6), voxel, {-1.6f, -1.6f, 0}}, p);
  GasSource source = ball({0, 0, float(size)}, float(size));
  source.heat = float(power) * 1e3f;
  double n = 0, sum_t = 0, sum_y = 0, tt = 0, ty = 0;
  for (int i = 1; i <= 50; ++i) {
    gas->step(0.1f, std::span(&source, 1), {});
    const double z = front_of(*gas, power) - size, t = 0.1 * i;  // from the middle of the source
    if (z < 0.8 || z > 4.5) continue;
    const double y = std::pow(z, 4.0 / 3);
    n += 1, sum_t += t, sum_y += y, tt += t * t, ty += t * y;
  }
  Start start;
  start.speed = (n * ty - sum_t * sum_y) / (n * tt - sum_t * sum_t);
  start.late = sum_t / n - sum_y / n / start.speed;
  return start;
}

TEST(GasPlumes, StartWhenTheirSourceHasLiftedItsAir) {
  for (const double power : {5.0, 20.0, 60.0}) {
    for (const double size : {0.15, 0.25, 0.4}) {
      const Start start = start_of(power, size, 0.1f);
      const double flux = 9.81 * power * 1e3 / (1.204 * 1005 * 293);  // of buoyancy [m⁴/s³]
      const double time = std::pow(std::pow(size, 4) / flux, 1.0 / 3);
      std::printf("%.0f kW, %.2f m: z^(4/3) = %.2f (t - %.2f s), (R^4/B)^(1/3) = %.2f s: %.2f\n",
                  power, size, start.speed, start.late, time, start.late / time);
    }
  }
}

}  // namespace
}  // namespace gloam

// Fire: how high flames are.

#include "gas_room.h"

namespace gloam {
namespace {

/// Heat release of turbulent diffusion flames per volume [W/m³] (Orloff and de Ris 1982).
constexpr float kFullOfFlame = 1.2e6f;

/// Mean height of flames above a burner [m]: up to where some voxel is a quarter full of flame.
double flame_height(double kilowatts, float diameter, float voxel, float height) {
  const auto cells = [voxel](float size) { return int(std::round(size / voxel)); };
  const float width = std::max(3 * diameter, 2.0f);
  const GasGrid grid{cells(width), cells(width), cells(height), voxel, {-width / 2, -width / 2, 0}};
  GasProperties p;
  p.open[4] = false;
  auto gas = make_gas(grid, p);
  GasSource burner;
  burner.X_WS.p = {0, 0, 0.5f * voxel};
  burner.half_size = {diameter / 2, diameter / 2, 0.6f * voxel};
  burner.fuel = float(kilowatts * 1e3) / p.heat_of_combustion;
  std::vector<float> power;
  double sum = 0;
  const int settle = 40, steps = 60;
  for (int n = 0; n < settle + steps; ++n) {
    gas->step(0.1f, std::span(&burner, 1), {});
    if (n < settle) continue;
    gas->read_heat_release(&power);
    size_t top = 0;
    for (size_t c = 0; c < power.size(); ++c) {
      if (power[c] > 0.25f * kFullOfFlame) top = c / (size_t(grid.nx) * size_t(grid.ny)) + 1;
    }
    sum += double(top) * double(voxel) / steps;
  }
  return sum;
}

/// Heskestad (1983): L = 0.235 Q^(2/5) - 1.02 D, in kW and m.
void check_flame(double kilowatts, float diameter, float voxel, float height) {
  const double law = 0.235 * std::pow(kilowatts, 0.4) - 1.02 * double(diameter);
  const double is = flame_height(kilowatts, diameter, voxel, height);
  printf("%.0f kW on %.1f m, voxels of %.2f m: flames of %.2f m, law %.2f m\n", kilowatts, diameter,
         voxel, is, law);
  EXPECT_NEAR(is, law, 0.3 * law) << "m";
}

TEST(GasFire, FlamesAreAsHighAsMeasured) { check_flame(100, 0.5f, 0.1f, 3); }
TEST(GasFlames, FlamesAreAsHighAsMeasured) { check_flame(500, 0.8f, 0.1f, 4.5f); }

}  // namespace
}  // namespace gloam

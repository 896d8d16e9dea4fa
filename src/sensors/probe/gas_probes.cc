// Probes of the fields of a [[gas]]: linear between the centres of its cells, as they are at its
// walls beyond the outermost ones, and linear between its ticks.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sensors/probe/probe_families.h"
#include "world/world.h"

namespace gloam {
namespace {

using GridOf = const VolumeGrid& (MediumField::*)() const;

/// Weights of the eight cells around a place.
struct GridPlace {
  std::array<size_t, 8> cells{};
  std::array<double, 8> weights{};

  GridPlace(const GasDescription& gas, const Vec3& p) {
    const int n[3] = {gas.nx, gas.ny, gas.nz};
    const double at[3] = {p.x - double{gas.low.x}, p.y - double{gas.low.y},
                          p.z - double{gas.low.z}};
    int low[3];
    double part[3];
    for (size_t a = 0; a < 3; ++a) {
      const double x = std::clamp(at[a] / double{gas.voxel} - 0.5, 0.0, n[a] - 1.0);
      low[a] = std::min(static_cast<int>(x), std::max(n[a] - 2, 0));
      part[a] = x - low[a];
    }
    for (size_t corner = 0; corner < 8; ++corner) {
      weights[corner] = 1;
      for (size_t a = 3; a-- > 0;) {
        const int side = static_cast<int>(corner >> a & 1);
        weights[corner] *= side != 0 ? part[a] : 1 - part[a];
        cells[corner] = cells[corner] * static_cast<size_t>(n[a]) +
                        static_cast<size_t>(std::min(low[a] + side, n[a] - 1));
      }
    }
  }

  /// Adds `share` of the grid there. Grids have as many numbers a cell as `to`.
  void add(const VolumeGrid& grid, double share, std::span<double> to) const {
    if (grid == nullptr || grid->empty()) return;
    for (size_t corner = 0; corner < 8; ++corner)
      for (size_t i = 0; i < to.size(); ++i)
        to[i] += share * weights[corner] * double{(*grid)[cells[corner] * to.size() + i]};
  }
};

void read_window(const FieldWindow& window, GridOf grid, const GridPlace& place,
                 std::span<double> to) {
  std::ranges::fill(to, 0.0);
  window.before->wait();
  const double share = double{window.share};
  place.add((*window.before.*grid)(), 1 - share, to);
  if (share == 0) return;
  window.after->wait();
  place.add((*window.after.*grid)(), share, to);
}

Result<ProbeReader> gas_probe(const ProbeDescription& probe, GridOf grid) {
  return ProbeReader([&probe, grid](ProbeInstant& at, std::span<double> numbers) -> Status {
    GLOAM_TRY(const Vec3 p, at.place(probe));
    const std::vector<GasDescription>& gases = at.world().gases.gases;
    for (size_t row = 0; row < gases.size(); ++row) {
      if (!gases[row].holds(p)) continue;
      const FieldWindow& window = at.data().effects.media[row];
      if (window.before == nullptr) break;
      read_window(window, grid, GridPlace(gases[row], p), numbers);
      return {};
    }
    std::ranges::fill(numbers, std::numeric_limits<double>::quiet_NaN());
    return {};
  });
}

}  // namespace

Result<ProbeReader> gas_velocity_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return gas_probe(probe, &MediumField::velocity);
}
Result<ProbeReader> gas_density_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return gas_probe(probe, &MediumField::density);
}
Result<ProbeReader> gas_temperature_probe(const ProbeDescription& probe, const ProbeSetup&) {
  return gas_probe(probe, &MediumField::temperature);
}

}  // namespace gloam

#include "sim/effects/dust/ground_dust.h"

#include <algorithm>
#include <cmath>

#include "sim/effects/dust/dust_law.h"
#include "sim/effects/wind/wind.h"

namespace gloam {
namespace {

constexpr int kMostRings = 10;  // rings of cells around a deposit that are searched for air

}  // namespace

GroundDust::GroundDust(const std::vector<DustDescription>& dusts, const GasGrid& grid)
    : dusts_(dusts), grid_(grid) {
  const size_t columns = static_cast<size_t>(grid.nx) * static_cast<size_t>(grid.ny);
  ground_.resize(columns);
  emissions_.reserve(columns);
}

void GroundDust::find_ground(const GasWalls& still, bool floor) {
  for (int j = 0; j < grid_.ny; ++j) {
    for (int i = 0; i < grid_.nx; ++i) {
      int& ground = ground_[static_cast<size_t>(j * grid_.nx + i)];
      ground = -1;
      for (int k = 0; k < grid_.nz && ground < 0; ++k) {
        const bool below = still.closed[2][still.face(2, i, j, k)] != 0 || (k == 0 && floor);
        if (below && still.solid[still.cell(i, j, k)] == 0) ground = k;
      }
    }
  }
}

void GroundDust::blow(const GasSolver& air, const GasWalls& still) {
  const double area = double{grid_.voxel} * double{grid_.voxel};
  for (int j = 0; j < grid_.ny; ++j) {
    for (int i = 0; i < grid_.nx; ++i) {
      const int k = ground_[static_cast<size_t>(j * grid_.nx + i)];
      if (k < 0) continue;
      const Vec3f cell{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f,
                       static_cast<float>(k)};
      const Vec3f at = grid_.low + cell * grid_.voxel;
      const auto dust = std::find_if(dusts_.begin(), dusts_.end(),
                                     [&at](const DustDescription& d) { return d.holds(at); });
      if (dust == dusts_.end()) continue;
      const float height = grid_.voxel / 2;
      const Vec3f v = air.velocity_at({at.x, at.y, at.z + height});
      const double shear = friction_velocity(double{std::hypot(v.x, v.y)}, double{height});
      const double flux =
          saltation_dust(shear, double{dust->threshold}, double{dust->clay}, kAirDensity);
      if (flux > 0) emissions_.push_back({still.cell(i, j, k), static_cast<float>(flux * area)});
    }
  }
}

// Into the nearest air around what raised it, in the layer of cells above the ground.
void GroundDust::put(const GasWalls& still, const GasWalls& walls,
                     std::span<const DustDeposit> deposits, double interval) {
  const auto along = [](float x, int n) { return std::clamp(static_cast<int>(x), 0, n - 1); };
  for (const DustDeposit& deposit : deposits) {
    const Vec3f p = (deposit.p - grid_.low) / grid_.voxel;
    const int i = along(p.x, grid_.nx), j = along(p.y, grid_.ny);
    int k = along(p.z + 0.25f, grid_.nz);
    while (k + 1 < grid_.nz && still.solid[still.cell(i, j, k)] != 0) ++k;  // from soil
    const size_t first = emissions_.size();
    for (int ring = 0; ring <= kMostRings && emissions_.size() == first; ++ring) {
      for (int y = std::max(j - ring, 0); y <= std::min(j + ring, grid_.ny - 1); ++y) {
        for (int x = std::max(i - ring, 0); x <= std::min(i + ring, grid_.nx - 1); ++x) {
          const bool on_ring = std::max(std::abs(x - i), std::abs(y - j)) == ring;
          const size_t cell = walls.cell(x, y, k);
          if (on_ring && walls.solid[cell] == 0) emissions_.push_back({cell, 0});
        }
      }
    }
    const double cells = static_cast<double>(emissions_.size() - first);
    for (size_t n = first; n < emissions_.size(); ++n)
      emissions_[n].rate = static_cast<float>(double{deposit.mass} / (interval * cells));
  }
}

std::span<const GasEmission> GroundDust::find(const GasSolver& air, const GasWalls& still,
                                              const GasWalls& walls, bool floor,
                                              std::span<const DustDeposit> deposits,
                                              double interval) {
  find_ground(still, floor);
  emissions_.clear();
  blow(air, still);
  put(still, walls, deposits, interval);
  std::sort(emissions_.begin(), emissions_.end(), [](const GasEmission& a, const GasEmission& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.rate < b.rate;
  });
  size_t n = 0;
  for (size_t i = 0; i < emissions_.size(); ++i) {
    if (n > 0 && emissions_[n - 1].cell == emissions_[i].cell) {
      emissions_[n - 1].rate += emissions_[i].rate;
    } else {
      emissions_[n++] = emissions_[i];
    }
  }
  emissions_.resize(n);
  return emissions_;
}

}  // namespace gloam

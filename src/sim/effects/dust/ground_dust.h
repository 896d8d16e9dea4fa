#pragma once
// Dust that cells of a gas receive in a tick: from ground that air blows over, and from deposits of
// contacts.

#include <span>
#include <vector>

#include "sim/effects/dust/contact_dust.h"
#include "sim/effects/gas/gas_solver.h"

namespace gloam {

class GroundDust {
 public:
  GroundDust(const std::vector<DustDescription>& dusts, const GasGrid& grid);

  /// `walls`: of now; `still`: of what stands still: ground is the lowest of them in each column of
  /// cells that air lies on. `floor`: is the box closed below? `interval` [s]: in which deposits
  /// come. The result, by cells, lives until the next call.
  std::span<const GasEmission> find(const GasSolver& air, const GasWalls& still,
                                    const GasWalls& walls, bool floor,
                                    std::span<const DustDeposit> deposits, double interval);

 private:
  void find_ground(const GasWalls& still, bool floor);
  void blow(const GasSolver& air, const GasWalls& still);
  void put(const GasWalls& still, const GasWalls& walls, std::span<const DustDeposit> deposits,
           double interval);

  const std::vector<DustDescription>& dusts_;
  GasGrid grid_;
  std::vector<int> ground_;  // k of the lowest cell of air above ground, by column; -1 = none
  std::vector<GasEmission> emissions_;
};

}  // namespace gloam

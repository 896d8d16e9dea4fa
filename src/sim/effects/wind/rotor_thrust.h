#pragma once
// Rotors of a World at an instant: places of their discs, and thrust.

#include <memory>
#include <vector>

#include "sim/effects/gas/gas_solver.h"
#include "sim/snapshots/snapshot.h"
#include "world/world.h"

namespace gloam {

/// MuJoCo's actuator forces at a Snapshot's own state, with the controls of the step that led to
/// it. Used by one thread at a time.
class RotorThrust {
 public:
  /// Errors: MuJoCo's.
  static Result<std::unique_ptr<RotorThrust>> create(std::shared_ptr<const CompiledWorld> world);

  /// Fills `rotors`, by row of GasesDescription::rotors. Error: MuJoCo's.
  Status solve(const Snapshot& snapshot, std::vector<GasRotor>* rotors);

 private:
  explicit RotorThrust(std::shared_ptr<const CompiledWorld> world);

  std::shared_ptr<const CompiledWorld> world_;
  mjModel model_;  // options of its own, the World's arrays
  DataPtr data_;
};

}  // namespace gloam

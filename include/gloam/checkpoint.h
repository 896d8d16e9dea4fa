#pragma once
// Checkpoint: an instant of a simulation, from which any simulation of the same scene can continue.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "gloam/command.h"
#include "gloam/world.h"

namespace gloam {

struct CheckpointData;  // src/sim/loop/checkpoint.h

/// Immutable and cheap to copy; outlives its simulation. Any thread.
class Checkpoint {
 public:
  explicit Checkpoint(std::shared_ptr<const CheckpointData> data) : data_(std::move(data)) {}

  int64_t step() const;   ///< since reset
  double time() const;    ///< simulation time [s]
  uint64_t seed() const;  ///< seed of the run
  uint64_t hash() const;  ///< hash of the state; a restored simulation has the same hash
  World world() const;    ///< World that was running
  /// Posted Commands that have led here from step 0, each with the step at which it applied.
  const std::vector<Command>& commands() const;
  /// Whether restore() copies the state. Otherwise (with effects, agents, or controllers without
  /// Controller::clone()) it steps the run again from its beginning, as fast as possible.
  bool is_copied() const;

  const CheckpointData& data() const { return *data_; }

 private:
  std::shared_ptr<const CheckpointData> data_;
};

}  // namespace gloam

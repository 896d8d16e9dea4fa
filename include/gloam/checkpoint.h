#pragma once
// Checkpoint: an instant of a simulation that any simulation of the same scene can go on from.

#include <cstdint>
#include <memory>
#include <utility>

#include "gloam/world.h"

namespace gloam {

struct CheckpointData;  // src/sim/loop/checkpoint.h

/// Immutable and cheap to copy; outlives its simulation. Any thread.
class Checkpoint {
 public:
  explicit Checkpoint(std::shared_ptr<const CheckpointData> data) : data_(std::move(data)) {}

  int64_t step() const;   ///< since reset
  double time() const;    ///< simulation time [s]
  uint64_t seed() const;  ///< of the run
  uint64_t hash() const;  ///< of the state; a restored simulation has the same
  World world() const;    ///< the one that ran
  /// Whether restoring takes a copy. Else the run is stepped again from its beginning, as fast as
  /// the machine can: with effects, agents, or controllers without Controller::clone().
  bool is_copied() const;

  const CheckpointData& data() const { return *data_; }

 private:
  std::shared_ptr<const CheckpointData> data_;
};

}  // namespace gloam

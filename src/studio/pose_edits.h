#pragma once
// Changes of a paused simulation's state: shown at once, and applied before the next step. Used by
// one thread at a time.

#include <mutex>
#include <vector>

#include "gloam/command.h"
#include "gloam/simulation.h"

namespace gloam::studio {

class PoseEdits {
 public:
  explicit PoseEdits(Simulation& simulation) : simulation_(simulation) {}

  /// Applies Commands now if the simulation runs; keeps them otherwise, each in place of an earlier
  /// one for the same element. Error: a Command that does not fit the model.
  Status apply(std::vector<Command> commands);
  /// Posts the kept Commands.
  Status post();
  void forget();
  bool empty() const { return commands_.empty(); }
  /// The present instant with the changes. Any thread.
  Snapshot shown() const;

 private:
  Simulation& simulation_;
  std::vector<Command> commands_;
  mutable std::mutex mutex_;  // guards shown_
  Snapshot shown_;            // empty without changes
};

}  // namespace gloam::studio

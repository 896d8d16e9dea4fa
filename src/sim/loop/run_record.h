#pragma once
// RunRecord: everything that has led a run from its initial state to an instant. By the promise of
// determinism, stepping from it again leads to the same state hash.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gloam/command.h"
#include "sim/loop/hook_inputs.h"
#include "world/world.h"

namespace gloam {

struct RunRecord {
  /// A World and the step from which the run has been in it.
  struct Chapter {
    std::shared_ptr<const CompiledWorld> world;
    int64_t from = 0;
  };

  uint64_t seed = 1;
  std::optional<double> timestep = {};  ///< instead of the model's [s]
  std::vector<Chapter> chapters;        ///< the first from step 0, then one per recompile
  std::vector<Command> commands = {};   ///< posted ones, each with the step it applied at
  /// Numbers that step hooks wrote, where a log has kept them; in a live run those before
  /// first_step.
  std::vector<StepInput> inputs = {};
  int64_t step = 0;        ///< the instant's
  uint64_t hash = 0;       ///< of its state, chained from the initial one
  int64_t first_step = 0;  ///< of a run that went on from a checkpoint; 0 = of others

  /// The World that a Command at `step` is for.
  const CompiledWorld& world_at(int64_t step) const {
    const Chapter* found = &chapters.front();
    for (const Chapter& chapter : chapters)
      if (chapter.from <= step) found = &chapter;
    return *found->world;
  }
};

}  // namespace gloam

#pragma once
// RunRecord: everything that has led a run from its initial state to an instant. By the promise of
// determinism, stepping from it again leads to the same state hash.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gloam/command.h"
#include "sim/loop/hook_inputs.h"
#include "world/world.h"

namespace gloam {

/// The inputs from which a World is compiled again, and a hash by which to recognise it.
struct WorldSource {
  Scene scene;
  std::string keyframe;
  uint64_t sizes = 0;  ///< hash of the numbers of the model's elements
};

struct RunRecord {
  /// A World and the step from which the run has been in it. A long run goes through many Worlds of
  /// 100 MB: the loop releases those of the past and keeps what compiles to them.
  struct Chapter {
    std::shared_ptr<const CompiledWorld> world;  ///< null once released
    int64_t from = 0;
    std::shared_ptr<const WorldSource> source = {};  ///< of a released World

    void release();
    /// The World, compiled again if it was released. Error: it does not compile any more, or its
    /// files have changed.
    Result<std::shared_ptr<const CompiledWorld>> compiled() const;
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
};

}  // namespace gloam

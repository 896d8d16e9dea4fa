#pragma once
// HookInputs: numbers of the state that step hooks write, kept for logs so that a run with a hook
// can be stepped again.

#include <mujoco/mujoco.h>

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace gloam {

/// Numbers that a hook wrote before one step.
struct StepInput {
  int64_t run = 0, step = 0;
  std::vector<int32_t> index;  ///< in mjSTATE_INTEGRATION
  std::vector<double> value;
};

/// Writes them into mjData, as the hook did. Indices must be of its state.
void apply_input(const mjModel& model, const StepInput& input, std::vector<double>* scratch,
                 mjData* data);

/// A ring of what one thread, the simulation's, writes and another takes. Allocates nothing while
/// the simulation steps.
class HookInputs {
 public:
  /// `capacity`: numbers that wait to be taken.
  explicit HookInputs(int64_t capacity = int64_t{1} << 20);

  // ---- the sim thread ----
  void before_hook(const mjModel& model, const mjData& data);
  void after_hook(const mjModel& model, const mjData& data, int64_t run, int64_t step);

  // ---- one other thread ----
  std::vector<StepInput> take();
  /// Steps whose inputs found no room: a run with them cannot be stepped again.
  int64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  double& at(int64_t i) { return ring_[static_cast<size_t>(i) % ring_.size()]; }

  std::vector<double> before_, after_;  // of the sim thread
  std::vector<double> ring_;            // run, step, n, then n pairs of index and value
  std::atomic<int64_t> written_{0}, taken_{0}, lost_{0};
};

}  // namespace gloam

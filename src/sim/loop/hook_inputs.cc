#include "sim/loop/hook_inputs.h"

#include <cstring>

namespace gloam {
namespace {

constexpr int64_t kInputHead = 3;  // run, step, number of pairs

void read_state(const mjModel& model, const mjData& data, std::vector<double>* state) {
  // Sized at the first call, and after a recompile.
  state->resize(static_cast<size_t>(mj_stateSize(&model, mjSTATE_INTEGRATION)));
  mj_getState(&model, &data, state->data(), mjSTATE_INTEGRATION);
}

// Bits, since a hook may write a NaN or turn 0 to -0.
bool is_same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

void apply_input(const mjModel& model, const StepInput& input, std::vector<double>* scratch,
                 mjData* data) {
  read_state(model, *data, scratch);
  for (size_t i = 0; i < input.index.size(); ++i)
    (*scratch)[static_cast<size_t>(input.index[i])] = input.value[i];
  mj_setState(&model, data, scratch->data(), mjSTATE_INTEGRATION);
}

HookInputs::HookInputs(int64_t capacity) : ring_(static_cast<size_t>(capacity)) {}

void HookInputs::before_hook(const mjModel& model, const mjData& data) {
  read_state(model, data, &before_);
}

void HookInputs::after_hook(const mjModel& model, const mjData& data, int64_t run, int64_t step) {
  read_state(model, data, &after_);
  int64_t changed = 0;
  for (size_t i = 0; i < after_.size(); ++i) changed += is_same(before_[i], after_[i]) ? 0 : 1;
  if (changed == 0) return;
  int64_t to = written_.load(std::memory_order_relaxed);
  const int64_t waiting = to - taken_.load(std::memory_order_acquire);
  if (waiting + kInputHead + 2 * changed > static_cast<int64_t>(ring_.size())) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  for (const int64_t head : {run, step, changed}) at(to++) = static_cast<double>(head);
  for (size_t i = 0; i < after_.size(); ++i) {
    if (is_same(before_[i], after_[i])) continue;
    at(to++) = static_cast<double>(i);
    at(to++) = after_[i];
  }
  written_.store(to, std::memory_order_release);
}

std::vector<StepInput> HookInputs::take() {
  std::vector<StepInput> inputs;
  const int64_t end = written_.load(std::memory_order_acquire);
  int64_t from = taken_.load(std::memory_order_relaxed);
  while (from < end) {
    StepInput& input = inputs.emplace_back();
    input.run = static_cast<int64_t>(at(from++));
    input.step = static_cast<int64_t>(at(from++));
    for (auto n = static_cast<int64_t>(at(from++)); n > 0; --n) {
      input.index.push_back(static_cast<int32_t>(at(from++)));
      input.value.push_back(at(from++));
    }
  }
  taken_.store(from, std::memory_order_release);
  return inputs;
}

}  // namespace gloam

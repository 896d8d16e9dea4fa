#include "runtime/log/pose_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/memory.h"
#include "ros/codec.h"
#include "runtime/log/run_text.h"
#include "sim/state/state_transfer.h"
#include "world/model_memory.h"

namespace gloam {
namespace {

constexpr int64_t kFarSteps = 2000;  // beyond which reading on takes longer than a seek

}  // namespace

PoseMotion::PoseMotion(const McapReader& log, const LoggedRuns::Run& run,
                       std::shared_ptr<const CompiledWorld> to)
    : messages_(log.messages({.topics = {kStateTopic}})),
      run_(run.number),
      from_(run.record.chapters.front().world),
      to_(std::move(to)),
      same_(*from_, *to_),
      data_(make_data(*from_->model)),
      after_data_(make_data(*from_->model)),
      step_time_(run.record.timestep.value_or(from_->model->opt.timestep)),
      velocity_(static_cast<size_t>(from_->model->nv)) {}

Result<std::unique_ptr<PoseMotion>> PoseMotion::create(const McapReader& log,
                                                       const LoggedRuns::Run& run,
                                                       std::shared_ptr<const CompiledWorld> to) {
  if (run.record.chapters.size() != 1)
    return Error{ErrorKind::kUnsupported,
                 "the run was recompiled: its motion cannot be replayed in one World"};
  return or_no_memory("the poses of the run", [&]() -> Result<std::unique_ptr<PoseMotion>> {
    std::unique_ptr<PoseMotion> made(new PoseMotion(log, run, std::move(to)));
    GLOAM_TRY_STATUS(made->look_at(0));
    return made;
  });
}

// The next state of the run; nothing at its end.
Result<std::optional<gloam_msgs::State>> PoseMotion::next() {
  for (;;) {
    GLOAM_TRY(const McapMessage* message, messages_.next());
    if (message == nullptr) return std::optional<gloam_msgs::State>();
    if (before_ == std::nullopt) time_ = message->log_time;
    GLOAM_TRY(auto state, decode<gloam_msgs::State>(message->data));
    if (state.run < run_) continue;
    if (state.run > run_) return std::optional<gloam_msgs::State>();
    const auto size = static_cast<size_t>(mj_stateSize(from_->model.get(), mjSTATE_INTEGRATION));
    if (state.state.size() != size)
      return Error{ErrorKind::kInput,
                   fmt::format("the run's states have {} numbers, but the scene's states now have "
                               "{}: the poses cannot be read",
                               state.state.size(), size),
                   {},
                   "restore the files that it was recorded with"};
    return std::optional(std::move(state));
  }
}

// Reads the first two states at `time` or later.
Status PoseMotion::begin_at(uint64_t time) {
  messages_.seek(time);
  GLOAM_TRY(before_, next());
  GLOAM_TRY(after_, before_ ? next() : Result<std::optional<gloam_msgs::State>>(std::nullopt));
  return {};
}

// Brings the states around `step` in.
Status PoseMotion::look_at(int64_t step) {
  if (!first_) {
    GLOAM_TRY_STATUS(begin_at(0));
    if (!before_)
      return Error{ErrorKind::kInput, fmt::format("the log has no states of run {}", run_)};
    first_ = {before_->step, time_};
  }
  const bool is_back = !before_ || before_->step > step;
  const bool is_far = after_ && step - after_->step > kFarSteps;
  if (is_back || is_far) {
    constexpr double kMaxStateGap = 1;  // [s] by which states may lie apart
    const double dt = step_time_ * static_cast<double>(step - first_->step) - kMaxStateGap;
    GLOAM_TRY_STATUS(
        begin_at(first_->time + static_cast<uint64_t>(std::llround(std::max(0.0, dt) * 1e9))));
    if (!before_ || before_->step > step) GLOAM_TRY_STATUS(begin_at(first_->time));
  }
  while (after_ && after_->step <= step) {
    before_ = std::move(after_);
    GLOAM_TRY(after_, next());
  }
  return {};
}

void PoseMotion::interpolate(double share) {
  const mjModel& m = *from_->model;
  mjData &a = *data_, &b = *after_data_;
  mj_setState(&m, &b, after_->state.data(), mjSTATE_INTEGRATION);
  mj_differentiatePos(&m, velocity_.data(), share > 0 ? 1 / share : 1, a.qpos, b.qpos);
  mj_integratePos(&m, a.qpos, velocity_.data(), 1);
  const auto lerp = [share](mjtNum* x, const mjtNum* y, auto n) {
    for (decltype(n) i = 0; i < n; ++i) x[i] += share * (y[i] - x[i]);
  };
  lerp(a.qvel, b.qvel, m.nv);
  lerp(a.mocap_pos, b.mocap_pos, 3 * m.nmocap);
  for (mjtSize i = 0; i < m.nmocap; ++i) {
    mjtNum turn[3], *q = a.mocap_quat + 4 * i;
    mju_subQuat(turn, b.mocap_quat + 4 * i, q);
    mju_quatIntegrate(q, turn, share);
  }
  a.time += share * (b.time - a.time);
}

Status PoseMotion::advance(int64_t step, mjData* data) {
  GLOAM_TRY_STATUS(look_at(step));
  if (!after_ && step > before_->step)
    return Error{ErrorKind::kPartial, fmt::format("the log ends at step {}", before_->step)};
  mj_setState(from_->model.get(), data_.get(), before_->state.data(), mjSTATE_INTEGRATION);
  const int64_t since = step - before_->step;
  if (since > 0)
    interpolate(static_cast<double>(since) / static_cast<double>(after_->step - before_->step));
  if (since < 0)  // before the first state that was logged
    data_->time *= static_cast<double>(step) / static_cast<double>(before_->step);
  transfer_state(same_, *data_, *data);
  return {};
}

}  // namespace gloam

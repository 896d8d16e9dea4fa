// gloam::verify_log: a log's runs stepped again and compared.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "control/controllers.h"
#include "gloam/log.h"
#include "ros/codec.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/live/live_simulation.h"
#include "runtime/log/logged_runs.h"
#include "runtime/log/run_text.h"
#include "sim/loop/divergence.h"
#include "sim/loop/restepper.h"
#include "sim/state/state_layout.h"

namespace gloam {
namespace {

using Clock = std::chrono::steady_clock;

// The first joint whose numbers differ, and by how much; else that something else does.
std::string first_difference(const mjModel& m, std::span<const double> logged,
                             std::span<const double> again) {
  if (logged.size() != again.size())
    return fmt::format("the state has {} numbers, {} in the log", again.size(), logged.size());
  const auto part = [&](std::span<const double> state, mjtState what) {
    return state_part(m, state, what);
  };
  const auto qpos = part(logged, mjSTATE_QPOS), qpos_again = part(again, mjSTATE_QPOS);
  const auto qvel = part(logged, mjSTATE_QVEL), qvel_again = part(again, mjSTATE_QVEL);
  for (int joint = 0; joint < static_cast<int>(m.njnt); ++joint) {
    const JointWidth width = joint_width(m.jnt_type[joint]);
    for (int i = 0; i < width.qpos; ++i) {
      const auto at = static_cast<size_t>(m.jnt_qposadr[joint] + i);
      if (qpos[at] != qpos_again[at])
        return fmt::format("{}: position differs by {:.3g}", joint_label(m, joint),
                           std::abs(qpos[at] - qpos_again[at]));
    }
    for (int i = 0; i < width.qvel; ++i) {
      const auto at = static_cast<size_t>(m.jnt_dofadr[joint] + i);
      if (qvel[at] != qvel_again[at])
        return fmt::format("{}: velocity differs by {:.3g}", joint_label(m, joint),
                           std::abs(qvel[at] - qvel_again[at]));
    }
  }
  for (size_t i = 0; i < logged.size(); ++i)
    if (logged[i] != again[i])
      return fmt::format("element {} of the state differs by {:.3g}", i,
                         std::abs(logged[i] - again[i]));
  return "the state is equal but its hash is not: an effect, an agent or an earlier step differs";
}

class Verifier {
 public:
  Verifier(const McapReader& log, LoggedRuns runs, const ProgressCallback& progress)
      : log_(log), runs_(std::move(runs)), progress_(progress) {}

  Result<LogVerification> verify() {
    for (const auto& [number, run] : runs_.runs) total_ += run.last_step;
    McapMessages states = log_.messages({.topics = {kStateTopic}});
    for (;;) {
      GLOAM_TRY(const McapMessage* message, states.next());
      if (message == nullptr) break;
      GLOAM_TRY(const auto state, decode<gloam_msgs::State>(message->data));
      GLOAM_TRY_STATUS(compare(state));
    }
    finish_run();
    return std::move(found_);
  }

 private:
  Status compare(const gloam_msgs::State& state) {
    if (state.run != run_) GLOAM_TRY_STATUS(begin_run(state.run));
    if (stepper_ == nullptr) return {};
    GLOAM_TRY_STATUS(step_to(state.step));
    ++found_.states;
    // A state may have been taken before or after a recompile at its step.
    if (stepper_->has_chapter_here() && stepper_->loop().stepper().hash() != state.hash)
      GLOAM_TRY_STATUS(stepper_->begin_chapters());
    const Snapshot& again = stepper_->loop().stepper().snapshot();
    if (again.hash() == state.hash) {
      equal_ = state.step;
    } else {
      if (found_.is_equal()) {
        found_.run = run_;
        found_.equal_step = equal_;
        found_.step = state.step;
        found_.where =
            first_difference(stepper_->loop().stepper().model(), state.state, again.state());
      }
      // The chain of hashes cannot meet again: the rest of the run is another one.
      found_.differing += runs_.runs[run_].last_step - equal_;
      stepper_.reset();
    }
    return tell();
  }

  // In short stretches, so that the caller may cancel at any time.
  Status step_to(int64_t step) {
    constexpr int64_t kStepsPerCheck = 16;
    while (at_ < step) {
      const int64_t next = std::min(at_ + kStepsPerCheck, step);
      GLOAM_TRY_STATUS(stepper_->run_until(next));
      at_ = next;
      GLOAM_TRY_STATUS(tell());
    }
    return {};
  }

  Status begin_run(int64_t number) {
    finish_run();
    run_ = number;
    at_ = equal_ = 0;
    const LoggedRuns::Run& run = runs_.runs[number];
    GLOAM_TRY_STATUS(run.same_bits);
    if (!run.has_beginning) {
      found_.notes.push_back(fmt::format(
          "run {} started from a checkpoint, not from the scene, and was not verified", number));
      return {};
    }
    GLOAM_TRY(stepper_,
              Restepper::create(run.record, run.has_history ? robot_makers() : replay_makers()));
    ++found_.runs;
    return {};
  }

  void finish_run() {
    if (run_ >= 0 && runs_.runs[run_].has_beginning) done_ += runs_.runs[run_].last_step;
    found_.steps = done_;
    stepper_.reset();
  }

  Status tell() const {
    if (!progress_) return {};
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const double share =
        total_ > 0 ? static_cast<double>(done_ + at_) / static_cast<double>(total_) : 1;
    if (progress_({"verifying", share, seconds})) return {};
    return Error{ErrorKind::kInterrupted, "interrupted"};
  }

  const McapReader& log_;
  LoggedRuns runs_;
  const ProgressCallback& progress_;
  const Clock::time_point start_ = Clock::now();
  LogVerification found_;
  std::unique_ptr<Restepper> stepper_;
  int64_t run_ = -1, at_ = 0, equal_ = 0, done_ = 0, total_ = 0;
};

}  // namespace

Result<LogVerification> verify_log(const std::filesystem::path& file,
                                   const std::filesystem::path& folder,
                                   const ProgressCallback& progress) {
  GLOAM_TRY(const McapReader log, McapReader::open(file));
  GLOAM_TRY(LoggedRuns runs, LoggedRuns::read(log, folder));
  return Verifier(log, std::move(runs), progress).verify();
}

}  // namespace gloam

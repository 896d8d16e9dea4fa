#include "studio/history.h"

#include <algorithm>
#include <span>
#include <utility>

namespace gloam::studio {
namespace {

constexpr double kInterval = 0.5;                 // of simulation time between saved instants [s]
constexpr size_t kMaxSaved = 30;                  // 15 s
constexpr std::chrono::milliseconds kPause{100};  // at least, between two, where it runs fast

}  // namespace

void History::keep() {
  const Snapshot present = simulation_.latest();
  if (!present) return;
  const double time = present.time();
  const uint64_t world = present.world().serial();
  // A reset, a return by somebody else, or another World: nothing saved leads to the present.
  if (time < last_time_ || world != world_) saved_.clear();
  last_time_ = time;
  world_ = world;
  const auto now = Clock::now();
  if (!saved_.empty() && (time < saved_.back().time() + kInterval || now < saved_at_ + kPause))
    return;
  saved_at_ = now;
  Result<Checkpoint> checkpoint = simulation_.checkpoint();
  if (!checkpoint.ok()) return;  // it has failed, or its Commands were not kept
  saved_.push_back(std::move(checkpoint).value());
  if (saved_.size() > kMaxSaved) saved_.pop_front();
}

double History::start() const { return saved_.empty() ? last_time_ : saved_.front().time(); }

Status History::return_to(int64_t step) {
  simulation_.pause();
  const auto after = std::ranges::upper_bound(saved_, step, {}, &Checkpoint::step);
  if (after == saved_.begin())
    return Error{ErrorKind::kUsage, "the past before this instant was not kept"};
  const Checkpoint base = *std::prev(after);
  GLOAM_TRY(const Checkpoint present, simulation_.checkpoint());
  std::vector<Command> since;
  for (const Command& command : present.commands())
    if (command.step >= base.step() && command.step < step) since.push_back(command);
  GLOAM_TRY_STATUS(simulation_.restore(base));
  if (!since.empty()) GLOAM_TRY_STATUS(simulation_.post(since));
  saved_.erase(after, saved_.end());
  const Status status = simulation_.run_until(step);
  last_time_ = simulation_.latest().time();
  return status;
}

}  // namespace gloam::studio

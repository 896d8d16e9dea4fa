#include "studio/pose_edits.h"

#include <algorithm>
#include <utility>

namespace gloam::studio {
namespace {

/// Whether `b` sets all that `a` has set.
bool replaces(const Command& a, const Command& b) {
  if (a.what.index() != b.what.index()) return false;
  return std::visit(
      [&]<class T>(const T& first) {
        const T& second = std::get<T>(b.what);
        if constexpr (std::is_same_v<T, SetJointState>)
          return first.joint.id == second.joint.id &&
                 (first.qvel.empty() || !second.qvel.empty()) &&
                 (first.qpos.empty() || !second.qpos.empty());
        if constexpr (std::is_same_v<T, SetControl>) return first.actuator.id == second.actuator.id;
        if constexpr (std::is_same_v<T, SetMocapPose>) return first.body.id == second.body.id;
        if constexpr (std::is_same_v<T, SetEquality>)
          return first.equality.id == second.equality.id;
        return false;
      },
      a.what);
}

}  // namespace

Status PoseEdits::apply(std::vector<Command> commands) {
  const Snapshot now = simulation_.latest();
  if (!simulation_.paused() || !now) return simulation_.post(commands);
  std::vector<Command> all = commands_;
  for (Command& command : commands) {
    std::erase_if(all, [&](const Command& earlier) { return replaces(earlier, command); });
    all.push_back(std::move(command));
  }
  GLOAM_TRY(Snapshot shown, now.with(all));
  commands_ = std::move(all);
  const std::lock_guard lock(mutex_);
  shown_ = std::move(shown);
  return {};
}

Status PoseEdits::post() {
  if (commands_.empty()) return {};
  const Status status = simulation_.post(commands_);
  forget();
  return status;
}

void PoseEdits::forget() {
  commands_.clear();
  const std::lock_guard lock(mutex_);
  shown_ = {};
}

Snapshot PoseEdits::shown() const {
  {
    const std::lock_guard lock(mutex_);
    if (shown_) return shown_;
  }
  return simulation_.latest();
}

}  // namespace gloam::studio

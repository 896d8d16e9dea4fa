#include "sim/sim_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "base/check.h"
#include "sim/command_check.h"

namespace gloam {
namespace {
constexpr int kLargestQueue = 65536;
constexpr double kLongestWindow = 1000;  // [s]
constexpr int64_t kNever = std::numeric_limits<int64_t>::max();
}  // namespace

SimLoop::SimLoop(std::unique_ptr<Stepper> stepper, Rational timestep, CommandQueue& commands,
                 std::vector<Command> scene_commands, std::vector<LoggedCommand> replay)
    : stepper_(std::move(stepper)),
      timestep_(timestep),
      commands_(commands),
      scene_commands_(std::move(scene_commands)),
      replay_(std::move(replay)),
      goals_(stepper_->world().robots.size()),
      next_publication_(kNever) {}

Status SimLoop::add_controller(int robot, std::unique_ptr<Controller> controller, Rational rate) {
  GLOAM_TRY(
      ControllerSlot slot,
      ControllerSlot::make(stepper_->world(), {robot, std::move(controller), rate}, timestep_));
  slot.begin(stepper_->step_count());
  slot.controller->reset(&stepper_->model(), &stepper_->data());
  controllers_.push_back(std::move(slot));
  return {};
}

Status SimLoop::exchange(NextWorld& next, const Correspondence& same) {
  if (stepper_->failed())
    return Error{ErrorKind::kUsage,
                 "a simulation that has failed cannot go on in another World",
                 {},
                 "reset it first"};
  if (!replay_.empty())
    return Error{ErrorKind::kUsage, "a log that is replayed is of one World: no recompile"};
  if (!next.stepper->take_over(*stepper_, same)) return next.stepper->error();
  std::swap(stepper_, next.stepper);
  const int64_t step = stepper_->step_count();
  for (ControllerSlot& slot : next.controllers) {
    slot.begin(step);
    const int old = same.robot[static_cast<size_t>(slot.robot)];
    const auto before = std::find_if(controllers_.begin(), controllers_.end(),
                                     [old](const ControllerSlot& s) { return s.robot == old; });
    if (before == controllers_.end()) {
      slot.controller->reset(&stepper_->model(), &stepper_->data());
    } else {
      slot.controller->take_over(&stepper_->model(), &stepper_->data(), *before->controller);
    }
  }
  std::swap(controllers_, next.controllers);
  std::swap(scene_commands_, next.scene_commands);
  take_over_goals(same);
  commands_.translate(step, [&](const Command& command) {
    std::optional<Command> translated = same.translate(command);
    if (translated && !check_command(same.after, *translated)) translated.reset();
    return translated;
  });
  for (Subscription& s : subscriptions_) {
    s.forget_windows();
    stepper_->pool().add_slots(s.slots());
  }
  find_next_publication();
  return {};
}

// What the scene said about earlier times is past; but the goal of a robot that is new is the last
// of those that it would have got.
void SimLoop::take_over_goals(const Correspondence& same) {
  std::vector<VelocityTarget> before(same.robot.size());
  std::swap(before, goals_);
  for (scene_cursor_ = 0; scene_cursor_ < scene_commands_.size(); ++scene_cursor_) {
    const Command& command = scene_commands_[scene_cursor_];
    if (command.step >= stepper_->step_count()) break;
    if (std::holds_alternative<SetVelocityGoal>(command.what)) apply(command);
  }
  for (size_t robot = 0; robot < same.robot.size(); ++robot) {
    const int old = same.robot[robot];
    if (old >= 0) goals_[robot] = before[static_cast<size_t>(old)];
  }
}

Result<std::shared_ptr<SnapshotQueue>> SimLoop::subscribe(const SubscriptionOptions& options,
                                                          const std::shared_ptr<Signal>& signal) {
  if (options.capacity < 1 || options.capacity > kLargestQueue) {
    return Error{ErrorKind::kUsage, fmt::format("a queue of {} Snapshots is not in 1 … {}",
                                                options.capacity, kLargestQueue)};
  }
  GLOAM_TRY(StepSchedule schedule, StepSchedule::make(options.rate, options.phase, timestep_));
  if (options.window.num < 0 || options.window.den <= 0 || options.window.value() > kLongestWindow)
    return Error{ErrorKind::kUsage, fmt::format("a window of {:g} s is not in 0 … {} s",
                                                options.window.value(), kLongestWindow)};
  Subscription subscription;
  subscription.queue = std::make_shared<SnapshotQueue>(options, signal);
  subscription.schedule = schedule;
  subscription.keys = key_steps(options.window, timestep_);
  // Events may come a step early or late, those of uneven schedules a quarter of a period: a window
  // must end before so many more have begun.
  const int64_t period = schedule.step_of(Subscription::kMostPending) - schedule.step_of(0);
  const int64_t room = period - 2 - (options.due ? period / 4 / Subscription::kMostPending : 0);
  if (subscription.keys.length() > room) {
    return Error{ErrorKind::kUsage,
                 fmt::format("a window of {:g} s is too long for {:g} events a second",
                             options.window.value(), options.rate.value()),
                 {},
                 "shorten it or lower the rate"};
  }
  subscription.begin(stepper_->step_count());
  stepper_->pool().add_slots(subscription.slots());
  subscriptions_.push_back(std::move(subscription));
  find_next_publication();
  return subscriptions_.back().queue;
}

void SimLoop::find_next_publication() {
  next_publication_ = kNever;
  for (const Subscription& s : subscriptions_) {
    next_publication_ = std::min(next_publication_, s.due);
  }
}

int64_t SimLoop::Subscription::event_from(int64_t step) const {
  if (queue->options().due) return queue->options().due(step);
  return schedule.step_of(schedule.first_at_or_after(step));
}

void SimLoop::Subscription::begin(int64_t from) {
  event = due = event_from(from);
  for (Pending& window : pending) window = {};
  pending_count = 0;
}

// The instants of a window are of one World: those that are not complete will never be. Complete
// ones wait for room.
void SimLoop::Subscription::forget_windows() {
  int complete = 0;
  while (complete < pending_count &&
         pending[static_cast<size_t>(complete)].window.count == keys.count)
    ++complete;
  queue->count_lost(pending_count - complete);
  for (int i = complete; i < pending_count; ++i) pending[static_cast<size_t>(i)] = {};
  pending_count = complete;
  if (complete == 0) due = event;
}

// Snapshots of a full queue, of one with the reader, and of those being made.
int SimLoop::Subscription::slots() const {
  const SubscriptionOptions& options = queue->options();
  const int made = options.window.num > 0 ? kMostPending : 1;
  return (options.capacity + 1 + made) * keys.count;
}

/// Takes the Snapshot of this step where it belongs, and hands out what is complete. False when
/// there is no room for it.
bool SimLoop::Subscription::publish(int64_t step, Stepper& stepper) {
  if (event <= step) {
    GLOAM_CHECK(pending_count < kMostPending, "windows overlap more than was agreed");
    pending[static_cast<size_t>(pending_count++)].first = step;
    event = event_from(event + 1);
  }
  const auto next_key = [&](const Pending& p) { return p.first + p.window.count * keys.stride; };
  for (int i = 0; i < pending_count; ++i) {
    Pending& p = pending[static_cast<size_t>(i)];
    if (p.window.count < keys.count && next_key(p) <= step) p.window.add(stepper.snapshot());
  }
  while (pending_count > 0 && pending[0].window.count == keys.count) {
    if (queue->options().required && queue->full()) return false;
    queue->publish(std::exchange(pending[0].window, {}));
    std::rotate(pending.begin(), pending.begin() + 1, pending.begin() + pending_count);
    --pending_count;
  }
  due = event;
  for (int i = 0; i < pending_count; ++i)
    due = std::min(due, next_key(pending[static_cast<size_t>(i)]));
  return true;
}

bool SimLoop::publish_due() {
  const int64_t step = stepper_->step_count();
  if (step < next_publication_) return true;
  bool all = true;
  for (Subscription& s : subscriptions_) {
    if (s.due > step || s.queue->closed()) continue;
    all = s.publish(step, *stepper_) && all;
  }
  std::erase_if(subscriptions_, [this](const Subscription& s) {
    if (s.queue->closed()) dropped_by_closed_ += s.queue->dropped();
    return s.queue->closed();
  });
  find_next_publication();
  return all;
}

void SimLoop::apply(const Command& command) {
  if (const auto* goal = std::get_if<SetVelocityGoal>(&command.what)) {
    goal_of(goal->robot) = {goal->vx, goal->vy, goal->yaw_rate};
  } else {
    stepper_->apply(command);
  }
}

// True when one of them was a reset.
bool SimLoop::apply_commands() {
  const int64_t step = stepper_->step_count();
  while (scene_cursor_ < scene_commands_.size() && scene_commands_[scene_cursor_].step <= step) {
    apply(scene_commands_[scene_cursor_++]);
  }
  while (replay_cursor_ < replay_.size() && replay_[replay_cursor_].run == run_ &&
         replay_[replay_cursor_].command.step <= step) {
    const Command& command = replay_[replay_cursor_++].command;
    if (std::holds_alternative<ResetSim>(command.what)) {
      commands_.reset_now(step, run_);
      return true;
    }
    apply(command);
  }
  return commands_.maybe_due(step) &&
         commands_.apply_due(step, run_, [this](const Command& command) { apply(command); });
}

void SimLoop::run_controllers() {
  const int64_t step = stepper_->step_count();
  for (ControllerSlot& slot : controllers_) {
    if (slot.due > step) continue;
    slot.controller->control(&stepper_->model(), &stepper_->data(), step, slot.period,
                             goal_of(slot.robot));
    slot.due = slot.schedule.step_of(++slot.k);
  }
}

bool SimLoop::advance() {
  if (stepper_->failed()) return false;
  if (apply_commands()) {
    begin_run();
    return !stepper_->failed();
  }
  run_controllers();
  if (hook_) hook_(&stepper_->model(), &stepper_->data());
  return stepper_->step();
}

void SimLoop::reset() {
  commands_.reset_now(stepper_->step_count(), run_);
  begin_run();
}

void SimLoop::begin_run() {
  ++run_;
  scene_cursor_ = 0;
  while (replay_cursor_ < replay_.size() && replay_[replay_cursor_].run < run_) ++replay_cursor_;
  std::fill(goals_.begin(), goals_.end(), VelocityTarget{});
  if (!stepper_->reset()) return;
  for (ControllerSlot& slot : controllers_) {
    slot.k = slot.due = 0;
    slot.controller->reset(&stepper_->model(), &stepper_->data());
  }
  for (Subscription& s : subscriptions_) s.begin(0);
  find_next_publication();
}

int64_t SimLoop::dropped() const {
  int64_t dropped = dropped_by_closed_;
  for (const Subscription& s : subscriptions_) dropped += s.queue->dropped();
  return dropped;
}

void SimLoop::close_queues() {
  for (const Subscription& s : subscriptions_) s.queue->close();
}

}  // namespace gloam

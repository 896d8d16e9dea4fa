#include "sim/loop/sim_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "base/check.h"
#include "base/log.h"
#include "base/memory.h"
#include "sim/commands/command_check.h"
#include "sim/loop/checkpoint.h"

namespace gloam {
namespace {
constexpr int64_t kNever = std::numeric_limits<int64_t>::max();
}  // namespace

SimLoop::SimLoop(std::unique_ptr<Stepper> stepper, Rational timestep, CommandQueue& commands,
                 std::vector<Command> scene_commands, std::vector<LoggedCommand> replay,
                 ControllerMaker make_controller)
    : stepper_(std::move(stepper)),
      timestep_(timestep),
      commands_(commands),
      scene_commands_(std::move(scene_commands)),
      replay_(std::move(replay)),
      goals_(stepper_->world().robots.size()),
      pose_goals_(stepper_->world().robots.size()),
      make_controller_(std::move(make_controller)),
      controllers_(stepper_->world().robots.size()),
      chapters_{{stepper_->shared_world(), 0}},
      run_seed_(stepper_->seed()),
      next_publication_(kNever) {}

Status SimLoop::add_controller(int robot, std::unique_ptr<Controller> controller, Rational rate) {
  GLOAM_TRY(
      ControllerSlot slot,
      ControllerSlot::make(stepper_->world(), {robot, std::move(controller), rate}, timestep_));
  start_controller(&slot, nullptr);
  control_of(robot).now = std::move(slot);
  return {};
}

// Its first call is at this step or after it.
void SimLoop::start_controller(ControllerSlot* slot, const Controller* before) {
  slot->begin(stepper_->step_count());
  if (slot->controller == nullptr) return;
  if (before != nullptr)
    slot->controller->take_over(&stepper_->model(), &stepper_->data(), *before);
  else
    slot->controller->reset(&stepper_->model(), &stepper_->data());
}

void SimLoop::switch_controller(ControllerSlot* next) {
  const int robot = next->robot;
  RobotControl& control = control_of(robot);
  const auto type = [&](const ControllerSlot& slot) -> const std::string& {
    if (const ControllerOptions* options = slot.options.get()) return options->type;
    return stepper_->world().robots[static_cast<size_t>(robot)].options.controller.type;
  };
  if (type(*next) != type(control.now)) stepper_->joints().reset(robot);
  start_controller(next, control.now.controller.get());
  control.switch_to(next);
}

// A controller that a Command has set remains; it is made here, since the Command may have applied
// at any moment until now.
void SimLoop::exchange_controllers(NextWorld* next, const Correspondence& same) {
  std::vector<RobotControl> controls(same.robot.size());
  for (ControllerSlot& slot : next->controllers)
    controls[static_cast<size_t>(slot.robot)].now = std::move(slot);
  for (size_t robot = 0; robot < controls.size(); ++robot) {
    const int old = same.robot[robot];
    const RobotControl* before = old < 0 ? nullptr : &control_of(old);
    const bool was_switched = before != nullptr && before->is_switched();
    start_controller(&controls[robot].now, before == nullptr ? nullptr
                                           : was_switched    ? before->parked.controller.get()
                                                             : before->now.controller.get());
    if (!was_switched) continue;
    const Command again{.what = SetController{{static_cast<int>(robot), 0}, *before->now.options}};
    Result<std::unique_ptr<PreparedInput>> made =
        prepare_input(stepper_->shared_world(), again, timestep_, make_controller_);
    if (!made.ok()) {
      log_warning("robot '{}' returns to the controller of its scene: {}",
                  stepper_->world().robots[robot].name, made.error().to_string());
      continue;
    }
    start_controller(&(*made)->controller, before->now.controller.get());
    controls[robot].switch_to(&(*made)->controller);
  }
  controllers_ = std::move(controls);
}

Status SimLoop::add_robot(RobotController robot) {
  if (robot.actuators != nullptr)
    GLOAM_TRY_STATUS(stepper_->add_actuators(robot.robot, std::move(robot.actuators)));
  if (robot.controller == nullptr) return {};
  return add_controller(robot.robot, std::move(robot.controller), robot.rate);
}

Status SimLoop::exchange(NextWorld& next, const Correspondence& same) {
  if (stepper_->failed())
    return Error{ErrorKind::kUsage,
                 "a failed simulation cannot continue in another World",
                 {},
                 "reset it first"};
  if (!next.stepper->take_over(*stepper_, same)) return next.stepper->error();
  std::swap(stepper_, next.stepper);
  const int64_t step = stepper_->step_count();
  chapters_.back().release();
  chapters_.push_back({stepper_->shared_world(), step});
  exchange_controllers(&next, same);
  std::swap(scene_commands_, next.scene_commands);
  take_over_goals(same);
  commands_.translate(step, [&](const Command& command) -> std::optional<QueuedCommand> {
    std::optional<Command> translated = same.translate(command);
    if (!translated || !check_command(same.after, *translated)) return std::nullopt;
    auto prepared =
        prepare_input(stepper_->shared_world(), *translated, timestep_, make_controller_);
    if (!prepared.ok()) return std::nullopt;
    return QueuedCommand{std::move(*translated), std::move(*prepared)};
  });
  for (Subscription& s : subscriptions_) {
    s.forget_windows();
    stepper_->pool().add_slots(s.slots());
  }
  find_next_publication();
  return {};
}

// Commands of the scene for earlier times are past; but the goal of a robot that is new is the last
// of those that it would have got.
void SimLoop::take_over_goals(const Correspondence& same) {
  std::vector<VelocityTarget> before(same.robot.size());
  std::swap(before, goals_);
  for (scene_cursor_ = 0; scene_cursor_ < scene_commands_.size(); ++scene_cursor_) {
    const Command& command = scene_commands_[scene_cursor_];
    if (command.step >= stepper_->step_count()) break;
    if (std::holds_alternative<SetVelocityGoal>(command.what)) apply_unprepared(command);
  }
  for (size_t robot = 0; robot < same.robot.size(); ++robot) {
    const int old = same.robot[robot];
    if (old >= 0) goals_[robot] = before[static_cast<size_t>(old)];
  }
  std::vector<std::optional<Pose>> poses_before(same.robot.size());
  std::swap(poses_before, pose_goals_);
  for (size_t robot = 0; robot < same.robot.size(); ++robot) {
    const int old = same.robot[robot];
    if (old >= 0) pose_goals_[robot] = poses_before[static_cast<size_t>(old)];
  }
}

Result<std::shared_ptr<SnapshotQueue>> SimLoop::subscribe(const SubscriptionOptions& options,
                                                          const std::shared_ptr<Signal>& signal) {
  GLOAM_TRY(Subscription subscription, Subscription::make(options, timestep_, signal));
  subscription.begin(stepper_->step_count());
  stepper_->pool().add_slots(subscription.slots());
  subscriptions_.push_back(std::move(subscription));
  find_next_publication();
  return subscriptions_.back().queue();
}

void SimLoop::find_next_publication() {
  next_publication_ = kNever;
  for (const Subscription& s : subscriptions_) {
    next_publication_ = std::min(next_publication_, s.due());
  }
}

bool SimLoop::publish_due() {
  const int64_t step = stepper_->step_count();
  if (step < next_publication_) return true;
  bool all = true;
  for (Subscription& s : subscriptions_) {
    if (s.due() > step || s.queue()->closed()) continue;
    all = s.publish(step, *stepper_, waits_for_sensors_) && all;
  }
  std::erase_if(subscriptions_, [this](const Subscription& s) {
    if (s.queue()->closed()) dropped_by_closed_ += s.queue()->dropped();
    return s.queue()->closed();
  });
  find_next_publication();
  return all;
}

// Applies Commands from the scene, a log or a run that is repeated.
void SimLoop::apply_unprepared(const Command& command) {
  auto prepared = prepare_input(stepper_->shared_world(), command, timestep_, make_controller_);
  if (!prepared.ok()) {
    stepper_->fail(prepared.error());
    return;
  }
  apply(command, *prepared);
}

void SimLoop::apply(const Command& command, std::unique_ptr<PreparedInput>& prepared) {
  if (const auto* goal = std::get_if<SetVelocityGoal>(&command.what)) {
    goal_of(goal->robot.id) = {goal->vx, goal->vy, goal->yaw_rate, goal->vz};
  } else if (std::holds_alternative<SetController>(command.what)) {
    switch_controller(&prepared->controller);
  } else if (const auto* follow = std::get_if<FollowTrajectory>(&command.what)) {
    stepper_->joints().follow(follow->robot.id, stepper_->model(), stepper_->data(),
                              stepper_->step_count(), &prepared->trajectory);
  } else if (const auto* pose = std::get_if<SetPoseGoal>(&command.what)) {
    pose_goals_[static_cast<size_t>(pose->robot.id)] = pose->X_WF;
  } else {
    stepper_->apply(command);
  }
}

// True when one of them was a reset.
bool SimLoop::apply_commands() {
  const int64_t step = stepper_->step_count();
  while (scene_cursor_ < scene_commands_.size() && scene_commands_[scene_cursor_].step <= step) {
    apply_unprepared(scene_commands_[scene_cursor_++]);
  }
  while (replay_cursor_ < replay_.size() && replay_[replay_cursor_].run == run_ &&
         replay_[replay_cursor_].command.step <= step) {
    const Command& command = replay_[replay_cursor_++].command;
    if (std::holds_alternative<ResetSim>(command.what)) {
      commands_.reset_now(step, run_);
      return true;
    }
    apply_unprepared(command);
  }
  return commands_.maybe_due(step) &&
         commands_.apply_due(step, run_, [this](const Command& command, auto& prepared) {
           apply(command, prepared);
         });
}

bool SimLoop::has_logged_controllers() const {
  return std::ranges::any_of(controllers_,
                             [](const RobotControl& control) { return control.now.is_logged; });
}

void SimLoop::run_controllers(bool logged) {
  const int64_t step = stepper_->step_count();
  for (RobotControl& control : controllers_) {
    ControllerSlot& slot = control.now;
    if (slot.controller == nullptr || slot.due > step || slot.is_logged != logged) continue;
    stepper_->joints().update(slot.robot, stepper_->data().time);
    const std::optional<Pose>& pose = pose_goals_[static_cast<size_t>(slot.robot)];
    slot.controller->control({&stepper_->model(), &stepper_->data(), stepper_->events().loads, step,
                              slot.period, goal_of(slot.robot), stepper_->joints().targets(),
                              pose ? &*pose : nullptr});
    slot.due = slot.schedule.step_of(++slot.k);
  }
}

bool SimLoop::advance() {
  try {
    return take_step();
  } catch (const std::bad_alloc&) {
    return stepper_->fail(no_memory_for("the next step"));
  }
}

bool SimLoop::take_step() {
  if (stepper_->failed()) return false;
  if (stepper_->follows()) return stepper_->step();
  if (apply_commands()) {
    begin_run();
    return !stepper_->failed();
  }
  if (stepper_->failed()) return false;
  run_controllers(false);
  if (hook_ || has_logged_controllers()) run_hook();
  return stepper_->step();
}

void SimLoop::run_hook() {
  const mjModel& model = stepper_->model();
  mjData& data = stepper_->data();
  if (hook_inputs_ != nullptr) hook_inputs_->before_hook(model, data);
  run_controllers(true);
  if (hook_) hook_(&model, &data);
  if (hook_inputs_ != nullptr) hook_inputs_->after_hook(model, data, run_, stepper_->step_count());
}

void SimLoop::reset() {
  commands_.reset_now(stepper_->step_count(), run_);
  begin_run();
}

void SimLoop::end_run(double time) {
  run_ends_.end_run(time);
  ++run_;
}

void SimLoop::begin_run() {
  end_run(stepper_->time());
  scene_cursor_ = 0;
  while (replay_cursor_ < replay_.size() && replay_[replay_cursor_].run < run_) ++replay_cursor_;
  std::fill(goals_.begin(), goals_.end(), VelocityTarget{});
  std::fill(pose_goals_.begin(), pose_goals_.end(), std::nullopt);
  chapters_ = {{stepper_->shared_world(), 0}};
  run_seed_ = stepper_->seed();
  first_step_ = 0;
  earlier_inputs_.clear();
  if (!stepper_->reset()) return;
  for (RobotControl& control : controllers_) {
    control.restore_scene();
    if (control.now.controller != nullptr) start_controller(&control.now, nullptr);
  }
  for (Subscription& s : subscriptions_) s.begin(0);
  find_next_publication();
}

void SimLoop::jump(int64_t step) {
  end_run(stepper_->time());
  if (!stepper_->jump(step)) return;
  stepper_->set_run(run_);
  for (Subscription& s : subscriptions_) s.begin(stepper_->step_count());
  find_next_publication();
}

std::unique_ptr<LoopState> SimLoop::save() const {
  auto saved = std::make_unique<LoopState>();
  saved->stepper = stepper_->save();
  if (saved->stepper == nullptr) return nullptr;
  for (const RobotControl& control : controllers_) {
    std::optional<RobotControl> copy = control.clone();
    if (!copy) return nullptr;
    saved->controllers.push_back(std::move(*copy));
  }
  saved->goals = goals_;
  saved->pose_goals = pose_goals_;
  saved->scene_cursor = scene_cursor_;
  return saved;
}

Status SimLoop::restore(const LoopState& saved, const RunRecord& record) {
  GLOAM_CHECK(saved.controllers.size() == controllers_.size(),
              "the controllers must belong to the same World");
  const double end = stepper_->time();
  if (!stepper_->restore(*saved.stepper)) return stepper_->error();
  end_run(end);
  for (size_t i = 0; i < controllers_.size(); ++i) controllers_[i] = *saved.controllers[i].clone();
  goals_ = saved.goals;
  pose_goals_ = saved.pose_goals;
  scene_cursor_ = saved.scene_cursor;
  begin_run_at(record);
  return {};
}

void SimLoop::adopt(SimLoop& made, const RunRecord& record) {
  end_run(stepper_->time());
  std::swap(stepper_, made.stepper_);
  std::swap(controllers_, made.controllers_);
  std::swap(scene_commands_, made.scene_commands_);
  std::swap(scene_cursor_, made.scene_cursor_);
  std::swap(goals_, made.goals_);
  std::swap(pose_goals_, made.pose_goals_);
  for (const Subscription& s : subscriptions_) stepper_->pool().add_slots(s.slots());
  begin_run_at(record);
}

void SimLoop::begin_run_at(const RunRecord& record) {
  stepper_->set_run(run_);
  chapters_ = record.chapters;
  run_seed_ = record.seed;
  first_step_ = record.step;
  earlier_inputs_ = record.inputs;
  commands_.begin_history(record.commands, run_);
  for (Subscription& s : subscriptions_) s.begin(stepper_->step_count());
  find_next_publication();
}

int64_t SimLoop::dropped() const {
  int64_t dropped = dropped_by_closed_;
  for (const Subscription& s : subscriptions_) dropped += s.queue()->dropped();
  return dropped;
}

void SimLoop::flush_queues() {
  for (const Subscription& s : subscriptions_) s.queue()->flush();
}

void SimLoop::close_queues() {
  for (const Subscription& s : subscriptions_) s.queue()->close();
}

}  // namespace gloam

#include "runtime/live/input_log.h"

#include <algorithm>
#include <utility>

#include "sim/state/state_layout.h"
#include "world/world_robots.h"

namespace gloam {

void ReceivedInputs::add(Message message) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(message));
}

std::vector<ReceivedInputs::Message> ReceivedInputs::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

double time_of_step(const Snapshot& now, double timestep, int64_t run, int64_t step) {
  if (run != now.data().run) return static_cast<double>(step) * timestep;
  return now.time() - static_cast<double>(now.step() - step) * timestep;
}

void InputLog::follow(std::shared_ptr<const TopicTable> table, std::vector<Command> schedule) {
  table_ = std::move(table);
  schedule_ = std::move(schedule);
}

// Controls of a run begin as its first Snapshot has them; what the scene did before that is not the
// log's.
void InputLog::begin_run(const Snapshot& now) {
  if (run_ != now.data().run) scheduled_ = now.step();
  run_ = now.data().run;
  const mjModel& model = *now.data().world->model;
  const std::span<const double> controls = state_part(model, now.state(), mjSTATE_CTRL);
  controls_.assign(controls.begin(), controls.end());
}

// Commands of the scene that have applied by step `end` of the run.
void InputLog::add_scheduled(int64_t end, ByStep* by_step) {
  for (const Command& command : schedule_)
    if (command.step >= scheduled_ && command.step < end)
      (*by_step)[{run_, command.step}].commands.push_back(command);
  scheduled_ = std::max(scheduled_, end);
}

void InputLog::set_control(int place, double value) {
  const auto i = static_cast<size_t>(place);
  if (place < 0 || i >= controls_.size()) return;
  controls_[i] = value;
  is_set_[i] = 1;
}

void InputLog::set_controls(const Snapshot& now, const StepInputs& inputs) {
  const CompiledWorld& world = *now.data().world;
  const mjModel& m = *world.model;
  is_set_.assign(controls_.size(), 0);
  for (const Command& command : inputs.commands) {
    const auto* one = std::get_if<SetControl>(&command.what);
    if (one != nullptr && one->actuator.id < m.nactuator)
      set_control(m.actuator_ctrladr[one->actuator.id], one->value);
    const auto* all = std::get_if<SetControls>(&command.what);
    const auto robot = static_cast<size_t>(all != nullptr ? all->robot.id : 0);
    if (all == nullptr || robot >= world.robots.size()) continue;
    const std::vector<int> actuators = robot_actuators(m, world.robots[robot]);
    for (size_t i = 0; i < actuators.size() && i < all->values.size(); ++i)
      set_control(m.actuator_ctrladr[actuators[i]], all->values[i]);
  }
  const int first = state_offset(m, mjSTATE_CTRL);
  for (const StepInput* input : inputs.hook_inputs)
    for (size_t i = 0; i < input->index.size(); ++i)
      set_control(input->index[i] - first, input->value[i]);
}

void InputLog::take(const Snapshot& now, double timestep,
                    const std::vector<LoggedCommand>& commands,
                    const std::vector<StepInput>& hook_inputs) {
  if (table_ == nullptr) return;
  if (run_ < 0 || controls_.size() != static_cast<size_t>(now.data().world->model->nu))
    begin_run(now);
  ByStep by_step;
  for (const LoggedCommand& logged : commands)
    if (logged.run == run_ && std::holds_alternative<ResetSim>(logged.command.what))
      add_scheduled(logged.command.step, &by_step);  // the run ends there
  if (run_ == now.data().run) add_scheduled(now.step(), &by_step);
  for (const LoggedCommand& logged : commands)
    by_step[{logged.run, logged.command.step}].commands.push_back(logged.command);
  for (const StepInput& input : hook_inputs)
    by_step[{input.run, input.step}].hook_inputs.push_back(&input);
  for (const auto& [at, inputs] : by_step) {
    if (at.first == now.data().run && run_ != at.first) begin_run(now);
    set_controls(now, inputs);
    const double time = time_of_step(now, timestep, at.first, at.second);
    const AppliedCommands applied{time, inputs.commands, controls_, is_set_};
    for (const Topic& topic : *table_) {
      if (!topic.echo || std::ranges::count(topics_, topic.info.name) == 0) continue;
      if (topic.echo(applied, &bytes_)) write_(topic.info, time, at.first, bytes_);
    }
  }
  if (run_ != now.data().run) begin_run(now);
}

void InputLog::take(const std::vector<ReceivedInputs::Message>& received) {
  if (table_ == nullptr) return;
  for (const ReceivedInputs::Message& message : received)
    for (const Topic& topic : *table_)
      if (topic.info.name == message.topic && !topic.echo &&
          std::ranges::count(topics_, topic.info.name) > 0)
        write_(topic.info, message.time, message.run, message.data);
}

}  // namespace gloam

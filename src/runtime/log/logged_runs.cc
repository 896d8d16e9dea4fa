#include "runtime/log/logged_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "ros/codec.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/log/command_text.h"
#include "runtime/log/files/scene_folder.h"
#include "runtime/log/logged_text.h"
#include "runtime/log/run_text.h"
#include "runtime/log/state_order.h"
#include "runtime/log/topic_reader.h"
#include "sim/commands/command_check.h"

namespace gloam {
namespace {

/// A World of the log and from where it runs.
struct LoggedWorld {
  RunText text;
  std::shared_ptr<const CompiledWorld> world;
  Status same_bits;
};

class RunReader {
 public:
  RunReader(const McapReader& log, const std::filesystem::path& folder)
      : log_(log), folder_(folder) {}

  Result<LoggedRuns> read() {
    GLOAM_TRY_STATUS(refuse_empty_log(log_));
    GLOAM_TRY_STATUS(for_each(kWorldTopic, [this](const auto& m) { return add_world(m); }));
    if (worlds_.empty())
      return Error{ErrorKind::kInput,
                   log_.name() + " contains no Gloam run and cannot be replayed",
                   {},
                   "`gloam info` lists its contents"};
    GLOAM_TRY_STATUS(for_each(kInputTopic, [this](const auto& m) { return add_input(m); }));
    GLOAM_TRY_STATUS(for_each(kStateTopic, [this](const auto& m) { return add_state(m); }));
    GLOAM_TRY_STATUS(for_each(kCommandTopic, [this](const auto& m) { return add_command(m); }));
    for (auto& [number, run] : runs_.runs) add_chapters(number, &run);
    return std::move(runs_);
  }

 private:
  Status for_each(const char* topic, const auto& take) {
    McapMessages messages = log_.messages({.topics = {topic}});
    for (;;) {
      GLOAM_TRY(const McapMessage* message, messages.next());
      if (message == nullptr) return {};
      GLOAM_TRY_STATUS(take(*message));
    }
  }

  Status add_world(const McapMessage& message) {
    GLOAM_TRY(const std::string json, logged_text(log_, message));
    GLOAM_TRY(RunText text, parse_run_text(json));
    GLOAM_TRY(const SceneFolder folder, find_scene_folder(text, log_, folder_));
    GLOAM_TRY(auto world, compile_run(text, folder));
    Status same = check_same_bits(text, *world, folder);
    worlds_.push_back({std::move(text), std::move(world), std::move(same)});
    return {};
  }

  const LoggedWorld& world_at(int64_t run, int64_t step) const {
    const LoggedWorld* found = &worlds_.front();
    for (const LoggedWorld& world : worlds_)
      if (world.text.run < run || (world.text.run == run && world.text.step <= step))
        found = &world;
    return *found;
  }

  Status add_state(const McapMessage& message) {
    GLOAM_TRY(const auto state, decode<gloam_msgs::State>(message.data));
    const LoggedWorld& world = world_at(state.run, state.step);
    const double timestep =
        world.text.timestep > 0 ? world.text.timestep : world.world->model->opt.timestep;
    GLOAM_TRY_STATUS(order_.check(state, timestep, sets_time_.contains(state.run)));
    LoggedRuns::Run& run = runs_.runs[state.run];
    if (state.step == 0) run.has_beginning = true;
    if (run.first_step < 0) run.first_step = state.step;
    run.last_step = state.step;
    run.record.step = state.step;
    run.record.hash = state.hash;
    return {};
  }

  Status add_command(const McapMessage& message) {
    GLOAM_TRY(const std::string json, logged_text(log_, message));
    GLOAM_TRY(LoggedCommand logged, parse_command(json));
    if (std::holds_alternative<ResetSim>(logged.command.what)) return {};
    const LoggedWorld& at = world_at(logged.run, logged.command.step);
    if (!at.same_bits.ok()) return {};  // what its handles name may be another thing
    GLOAM_TRY_STATUS(check_command(*at.world, logged.command));
    runs_.runs[logged.run].record.commands.push_back(std::move(logged.command));
    return {};
  }

  Status add_input(const McapMessage& message) {
    GLOAM_TRY(auto input, decode<gloam_msgs::StepInput>(message.data));
    const CompiledWorld& world = *world_at(input.run, input.step).world;
    const int size = mj_stateSize(world.model.get(), mjSTATE_INTEGRATION);
    const bool fits = input.index.size() == input.value.size() &&
                      std::ranges::all_of(input.index, [&](int i) { return i >= 0 && i < size; });
    if (!fits)
      return Error{
          ErrorKind::kInput,
          fmt::format("{}: the inputs at step {} do not match the state", log_.name(), input.step)};
    constexpr int kTime = 0;  // place of the time in mjSTATE_INTEGRATION
    if (std::ranges::find(input.index, kTime) != input.index.end()) sets_time_.insert(input.run);
    runs_.runs[input.run].record.inputs.push_back(
        {input.run, input.step, std::move(input.index), std::move(input.value)});
    return {};
  }

  void add_chapters(int64_t number, LoggedRuns::Run* run) {
    const LoggedWorld& first = world_at(number, 0);
    RunRecord& record = run->record;
    record.seed = first.text.seed;
    if (first.text.timestep > 0) record.timestep = first.text.timestep;
    record.chapters = {{first.world, 0}};
    run->number = number;
    run->same_bits = first.same_bits;
    for (const LoggedWorld& world : worlds_) {
      if (world.text.run != number) continue;
      if (run->same_bits.ok()) run->same_bits = world.same_bits;
      run->has_history |= world.text.has_history;
      run->has_beginning |= world.text.has_history;
      if (world.text.step > 0) record.chapters.push_back({world.world, world.text.step});
    }
    std::ranges::stable_sort(record.commands, {}, &Command::step);
  }

  const McapReader& log_;
  const std::filesystem::path& folder_;
  std::vector<LoggedWorld> worlds_;
  std::set<int64_t> sets_time_;  // runs in which a step hook has set the time
  StateOrder order_{log_.name()};
  LoggedRuns runs_;
};

}  // namespace

Result<LoggedRuns> LoggedRuns::read(const McapReader& log, const std::filesystem::path& folder) {
  return RunReader(log, folder).read();
}

Result<const LoggedRuns::Run*> LoggedRuns::find(int64_t place) const {
  if (place >= 0 && place < static_cast<int64_t>(runs.size()))
    return &std::next(runs.begin(), static_cast<std::ptrdiff_t>(place))->second;
  return Error{
      ErrorKind::kUsage,
      fmt::format("the log has {} run(s), counted from 0, and no run {}", runs.size(), place)};
}

}  // namespace gloam

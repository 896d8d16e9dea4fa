#include "runtime/log/logged_runs.h"

#include <algorithm>

#include "ros/codec.h"
#include "ros/messages/gloam_msgs.h"
#include "runtime/log/command_text.h"
#include "runtime/log/run_text.h"
#include "sim/commands/command_check.h"

namespace gloam {
namespace {

std::string_view text_of(const McapMessage& message) {
  return {reinterpret_cast<const char*>(message.data.data()), message.data.size()};
}

/// A World of the log and from where it runs.
struct LoggedWorld {
  int64_t run, step;
  std::shared_ptr<const CompiledWorld> world;
};

class RunReader {
 public:
  RunReader(const McapReader& log, const std::filesystem::path& folder)
      : log_(log), folder_(folder) {}

  Result<LoggedRuns> read() {
    GLOAM_TRY_STATUS(for_each(kWorldTopic, [this](const auto& m) { return add_world(m); }));
    if (worlds_.empty())
      return Error{ErrorKind::kInput,
                   log_.name() + " holds no run of Gloam's: it cannot be stepped again",
                   {},
                   "`gloam info` tells what it holds"};
    GLOAM_TRY_STATUS(for_each(kStateTopic, [this](const auto& m) { return add_state(m); }));
    GLOAM_TRY_STATUS(for_each(kCommandTopic, [this](const auto& m) { return add_command(m); }));
    for (auto& [number, run] : runs_.runs) add_chapters(number, &run.record);
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
    GLOAM_TRY(const RunText text, parse_run_text(text_of(message)));
    GLOAM_TRY(auto world, compile_run(text, folder_));
    if (worlds_.empty()) {
      seed_ = text.seed;
      if (text.timestep > 0) timestep_ = text.timestep;
    }
    worlds_.push_back({text.run, text.step, std::move(world)});
    return {};
  }

  const LoggedWorld& world_at(int64_t run, int64_t step) const {
    const LoggedWorld* found = &worlds_.front();
    for (const LoggedWorld& world : worlds_)
      if (world.run < run || (world.run == run && world.step <= step)) found = &world;
    return *found;
  }

  Status add_state(const McapMessage& message) {
    GLOAM_TRY(const auto state, decode<gloam_msgs::State>(message.data));
    LoggedRuns::Run& run = runs_.runs[state.run];
    if (state.step == 0) run.begins_anew = true;
    if (state.step < run.last_step) return {};
    run.last_step = state.step;
    run.record.step = state.step;
    run.record.hash = state.hash;
    return {};
  }

  Status add_command(const McapMessage& message) {
    GLOAM_TRY(LoggedCommand logged, parse_command(text_of(message)));
    if (std::holds_alternative<ResetSim>(logged.command.what)) return {};
    const LoggedWorld& at = world_at(logged.run, logged.command.step);
    GLOAM_TRY_STATUS(check_command(*at.world, logged.command));
    runs_.runs[logged.run].record.commands.push_back(std::move(logged.command));
    return {};
  }

  void add_chapters(int64_t number, RunRecord* record) {
    record->seed = seed_;
    record->timestep = timestep_;
    record->chapters = {{world_at(number, 0).world, 0}};
    for (const LoggedWorld& world : worlds_)
      if (world.run == number && world.step > 0)
        record->chapters.push_back({world.world, world.step});
  }

  const McapReader& log_;
  const std::filesystem::path& folder_;
  std::vector<LoggedWorld> worlds_;
  uint64_t seed_ = 1;
  std::optional<double> timestep_;
  LoggedRuns runs_;
};

}  // namespace

Result<LoggedRuns> LoggedRuns::read(const McapReader& log, const std::filesystem::path& folder) {
  return RunReader(log, folder).read();
}

}  // namespace gloam

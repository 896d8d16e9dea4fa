// gloam::replay_log: a logged motion in a World that looks otherwise.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "runtime/log/logged_motion.h"
#include "runtime/log/pose_motion.h"
#include "runtime/log/replay_scene.h"
#include "runtime/recording/run_pipeline.h"
#include "sim/state/correspondence.h"

namespace gloam {
namespace {

// Commands of the run for another World, at the same times.
Result<std::vector<Command>> commands_for(const RunRecord& record, const CompiledWorld& world,
                                          double timestep) {
  const CompiledWorld& logged = *record.chapters.front().world;
  const double ratio = record.timestep.value_or(logged.model->opt.timestep) / timestep;
  const Correspondence same(logged, world);
  std::vector<Command> commands;
  for (const Command& command : record.commands) {
    std::optional<Command> translated = same.translate(command);
    if (!translated) continue;  // its thing is gone
    translated->step = std::llround(static_cast<double>(command.step) * ratio);
    commands.push_back(*std::move(translated));
  }
  return commands;
}

class Replay {
 public:
  Replay(const LogReplay& replay, const McapReader& log, const LoggedRuns::Run& run)
      : replay_(replay),
        log_(log),
        run_(run),
        logged_(*run.record.chapters.front().world),
        request_(replay.request) {
    request_.simulation.seed = run.record.seed;
    request_.simulation.timestep = run.record.timestep.value_or(0);
  }

  Result<RunReport> record(const ProgressCallback& progress) {
    const bool is_new = replay_.motion == ReplayMotion::kNewRun;
    GLOAM_TRY(const World world, compile_replay(replay_, run_));
    if (is_new) take_changes(logged_.written.sim, world.compiled()->written.sim);
    const double length = static_cast<double>(run_.last_step) *
                          run_.record.timestep.value_or(double{logged_.model->opt.timestep});
    if (request_.duration <= 0 || (!is_new && request_.duration > length))
      request_.duration = length;
    GLOAM_TRY(auto motion, is_new ? begin_anew(world) : motion_of(world));
    GLOAM_TRY(RunReport report, record_motion(world, request_, std::move(motion), progress));
    report.notes.insert(report.notes.begin(), notes_.begin(), notes_.end());
    return report;
  }

 private:
  Result<std::unique_ptr<Motion>> motion_of(const World& world) {
    if (replay_.motion == ReplayMotion::kStepped && run_.same_bits.ok() && run_.has_beginning) {
      GLOAM_TRY(auto stepped, LoggedMotion::create(run_, world.compiled()));
      return std::unique_ptr<Motion>(std::move(stepped));
    }
    notes_.emplace_back("poses only: bodies follow the logged states, interpolated in between");
    if (!run_.same_bits.ok()) notes_.back() += "; " + run_.same_bits.error().message;
    GLOAM_TRY(auto poses, PoseMotion::create(log_, run_, world.compiled()));
    return std::unique_ptr<Motion>(std::move(poses));
  }

  // Options of [sim] that a new run has other than the logged one.
  void take_changes(const SimOptions& logged, const SimOptions& now) {
    if (now.seed != logged.seed) request_.simulation.seed = now.seed;
    if (now.timestep != logged.timestep) request_.simulation.timestep = now.timestep.value_or(0);
    if (now.duration != logged.duration && request_.duration <= 0) request_.duration = now.duration;
  }

  // No motion: physics.
  Result<std::unique_ptr<Motion>> begin_anew(const World& world) {
    GLOAM_TRY_STATUS(run_.same_bits);  // else its Commands were not read
    if (!run_.has_beginning || run_.record.chapters.size() != 1)
      return Error{ErrorKind::kUnsupported,
                   "the run cannot be repeated: it was recompiled, or its Commands are not logged "
                   "from its beginning"};
    const double timestep = request_.simulation.timestep > 0
                                ? request_.simulation.timestep
                                : double{world.compiled()->model->opt.timestep};
    GLOAM_TRY(request_.commands, commands_for(run_.record, *world.compiled(), timestep));
    notes_.emplace_back(
        fmt::format("a new run: {} of the log's {} Commands are applied to the changed scene, "
                    "which has its own physics",
                    request_.commands.size(), run_.record.commands.size()));
    if (!run_.record.inputs.empty()) notes_.back() += "; values written by step hooks are omitted";
    return std::unique_ptr<Motion>();
  }

  const LogReplay& replay_;
  const McapReader& log_;
  const LoggedRuns::Run& run_;
  const CompiledWorld& logged_;
  RunRequest request_;
  std::vector<std::string> notes_;
};

// A replay must not overwrite the log that it reads.
Status check_log_is_kept(const LogReplay& replay) {
  const RunRequest& request = replay.request;
  std::error_code code;
  const auto folder = std::filesystem::absolute(replay.log).parent_path();
  const bool in_folder =
      request.overwrite && std::filesystem::equivalent(folder, request.out, code) && !code;
  if (!in_folder && !(std::filesystem::equivalent(replay.log, request.log.file, code) && !code))
    return {};
  return Error{
      ErrorKind::kUsage,
      fmt::format("the replay would overwrite {}, the log that it reads", replay.log.string()),
      {},
      "record it to another folder or file"};
}

}  // namespace

Result<RunReport> replay_log(const LogReplay& replay, const ProgressCallback& progress) {
  GLOAM_TRY_STATUS(check_log_is_kept(replay));
  GLOAM_TRY(const McapReader log, McapReader::open(replay.log));
  GLOAM_TRY(const LoggedRuns runs, LoggedRuns::read(log, replay.folder));
  GLOAM_TRY(const LoggedRuns::Run* run, runs.find(replay.run));
  return Replay(replay, log, *run).record(progress);
}

}  // namespace gloam

// gloam::replay_log: a logged motion in a World that looks otherwise.

#include <fmt/format.h>

#include "gloam/log_replay.h"
#include "runtime/log/logged_motion.h"
#include "runtime/recorded_run.h"
#include "sim/state/same_physics.h"

namespace gloam {
namespace {

/// The World that `scene` compiles to, if it moves as the log's does.
Result<World> compile_alike(const Scene& scene, const CompiledWorld& logged) {
  Result<World> world =
      logged.keyframe.empty() ? World::compile(scene) : World::compile_at(scene, logged.keyframe);
  if (!world.ok()) return world;
  const std::string field = physical_difference(*logged.model, *world->compiled()->model);
  if (field.empty()) return world;
  return Error{ErrorKind::kUsage, fmt::format("it would move otherwise: {} differs", field)};
}

// Says which of the settings changes physics.
Error name_the_setting(const LogReplay& replay, const CompiledWorld& logged, Error error) {
  for (const auto& [path, value] : replay.settings) {
    Scene alone = logged.written;
    if (!set_option(alone, path, value).ok()) continue;
    if (const auto world = compile_alike(alone, logged); !world.ok())
      return {ErrorKind::kUsage,
              fmt::format("'{}' changes the motion: {}", path, world.error().message),
              {},
              "run the scene anew with it; a replay changes what is seen alone"};
  }
  return error;
}

}  // namespace

Result<RunReport> replay_log(const LogReplay& replay, const ProgressCallback& progress) {
  GLOAM_TRY(const McapReader log, McapReader::open(replay.log));
  GLOAM_TRY(const LoggedRuns runs, LoggedRuns::read(log, replay.folder));
  const auto run = runs.runs.find(replay.run);
  if (run == runs.runs.end())
    return Error{ErrorKind::kInput,
                 fmt::format("{} has no run {}", replay.log.string(), replay.run)};
  const CompiledWorld& logged = *run->second.record.chapters.front().world;
  Scene scene = logged.written;
  for (const auto& [path, value] : replay.settings)
    GLOAM_TRY_STATUS(set_option(scene, path, value));
  if (!replay.outputs.empty()) set_record_outputs(replay.outputs, &scene);
  Result<World> world = compile_alike(scene, logged);
  if (!world.ok()) return name_the_setting(replay, logged, world.error());
  GLOAM_TRY(auto motion, LoggedMotion::create(run->second, world->compiled()));
  RunRequest request = replay.request;
  request.simulation.seed = run->second.record.seed;
  request.simulation.timestep = run->second.record.timestep.value_or(0);
  const double timestep =
      request.simulation.timestep > 0 ? request.simulation.timestep : logged.model->opt.timestep;
  const double length = static_cast<double>(run->second.last_step) * timestep;
  request.duration = request.duration > 0 ? std::min(request.duration, length) : length;
  return record_motion(*world, request, std::move(motion), progress);
}

}  // namespace gloam

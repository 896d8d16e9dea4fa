#include "runtime/log/replay_scene.h"

#include <fmt/format.h>

#include "gloam/options.h"
#include "runtime/log/void_options.h"
#include "sim/state/same_physics.h"

namespace gloam {
namespace {

Result<World> compile_scene(const Scene& scene, const CompiledWorld& logged) {
  return logged.keyframe.empty() ? World::compile(scene)
                                 : World::compile_at(scene, logged.keyframe);
}

/// `scene` without people and vehicles.
Scene without_agents(Scene scene) {
  scene.agents.clear();
  scene.crowds.clear();
  if (scene.adversity) scene.adversity->people = 0;
  return scene;
}

/// The World that `scene` compiles to, if bodies of the log's World move in it as they did. People
/// and vehicles may be added to a run without any: they walk by themselves and touch nothing.
Result<World> compile_alike(const Scene& scene, const CompiledWorld& logged) {
  Result<World> world = compile_scene(scene, logged);
  if (!world.ok()) return world;
  std::shared_ptr<const CompiledWorld> changed = world->compiled();
  if (logged.agents.empty() && !changed->agents.empty()) {
    GLOAM_TRY(const World alone, compile_scene(without_agents(scene), logged));
    changed = alone.compiled();
  }
  const std::string field = physical_difference(*logged.model, *changed->model);
  if (field.empty()) return world;
  return Error{
      ErrorKind::kUsage,
      fmt::format("the physics of the model differs in {}", field),
      {},
      "use --restep for a new run of the changed scene; a replay can change only its appearance"};
}

// Names the overlay or setting that changes physics.
Error name_the_cause(const LogReplay& replay, const CompiledWorld& logged, Error error) {
  const auto blame = [&](const Result<Scene>& alone, const std::string& name) {
    if (!alone.ok()) return false;
    const auto world = compile_alike(*alone, logged);
    if (!world.ok())
      error = {ErrorKind::kUsage,
               fmt::format("'{}' changes the motion: {}", name, world.error().message),
               {},
               world.error().hint};
    return !world.ok();
  };
  for (const auto& overlay : replay.overlays)
    if (blame(overlay_scene(logged.written, overlay), overlay.string())) return error;
  for (const auto& [path, value] : replay.settings) {
    Scene alone = logged.written;
    if (set_option(alone, path, value).ok() && blame(alone, path)) return error;
  }
  return error;
}

/// `scene` with the overlays, settings and outputs of the replay.
Result<Scene> changed_scene(const LogReplay& replay, Scene scene) {
  const size_t own = scene.randomize.size();
  for (const auto& overlay : replay.overlays) {
    GLOAM_TRY(scene, overlay_scene(scene, overlay));
  }
  for (size_t i = own; i < scene.randomize.size() && replay.draw_seed; ++i)
    if (!scene.randomize[i].seed) scene.randomize[i].seed = replay.draw_seed;
  for (const auto& [path, value] : replay.settings)
    GLOAM_TRY_STATUS(set_option(scene, path, value));
  if (!replay.outputs.empty()) set_record_outputs(replay.outputs, &scene);
  return scene;
}

}  // namespace

Result<World> compile_replay(const LogReplay& replay, const LoggedRuns::Run& run) {
  const CompiledWorld& logged = *run.record.chapters.front().world;
  GLOAM_TRY(const Scene scene, changed_scene(replay, logged.written));
  if (replay.motion == ReplayMotion::kNewRun) return compile_scene(scene, logged);
  GLOAM_TRY_STATUS(check_options_act(logged.written, scene));
  Result<World> world = compile_alike(scene, logged);
  if (!world.ok()) return name_the_cause(replay, logged, world.error());
  return world;
}

}  // namespace gloam

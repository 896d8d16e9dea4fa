// World::compile: resolve (scene -> values) -> model (built, or from the cache) -> descriptions.

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "base/memory.h"
#include "scene/files/mujoco_guard.h"
#include "scene/robots/robot_models.h"
#include "scene/validate/validate.h"
#include "world/cache/model_cache.h"
#include "world/compile/build_model.h"
#include "world/compile/describe_world.h"
#include "world/compile/resolve_scene.h"
#include "world/shapes/urdf_visuals.h"

namespace gloam {
namespace {

// Below this a model compiles as fast as its cache entry is read.
constexpr std::chrono::milliseconds kWorthCaching{20};

Result<World> compile_scene(const Scene& given, const std::string& keyframe,
                            const ProgressCallback& callback) {
  install_mujoco_handler();
  GLOAM_TRY(Scene written, with_robot_models(given));
  GLOAM_TRY_STATUS(validate_scene(written));
  CompileProgress progress(callback, compile_weight(written));
  GLOAM_TRY(const ResolvedScene resolved, resolve_scene(std::move(written), &progress));
  const auto start = std::chrono::steady_clock::now();
  ModelFiles files;
  auto world = load_cached_world(resolved.scene, resolved.place_hash);
  const bool is_cached = world != nullptr;
  if (!is_cached) {
    GLOAM_TRY(world, build_model(resolved, &files, &progress));
  }
  GLOAM_TRY_STATUS(describe_world(resolved, keyframe, world.get()));
  if (!is_cached) {
    add_urdf_visuals(resolved.scene, &files, world.get());
    world->files = files.dependencies();
    if (std::chrono::steady_clock::now() - start > kWorthCaching)
      store_cached_world(world, world->files);
  }
  progress.finish();
  return World(std::move(world));
}

}  // namespace

Result<World> World::compile(const Scene& scene, const ProgressCallback& progress) {
  return or_no_memory("the scene's model", [&] { return compile_scene(scene, "", progress); });
}

Result<World> World::compile_at(const Scene& scene, const std::string& keyframe,
                                const ProgressCallback& progress) {
  if (scene.bare_model.empty())
    return Error{ErrorKind::kUsage,
                 fmt::format("keyframe '{}': this is a scene, not a model", keyframe),
                 {scene.file.string(), 0, 0},
                 "set it on its robot: [[robot]] keyframe = \"NAME\""};
  return or_no_memory("the scene's model",
                      [&] { return compile_scene(scene, keyframe, progress); });
}

}  // namespace gloam

#include "sim/loop/run_record.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>

#include "base/hash.h"

namespace gloam {
namespace {

uint64_t hash_sizes(const mjModel& model) {
  uint64_t hash = 0;
#define X(name) hash = hash_bytes(&model.name, sizeof(model.name), hash);
  MJMODEL_SIZES
#undef X
  return hash;
}

}  // namespace

void RunRecord::Chapter::release() {
  if (world == nullptr) return;
  source = std::make_shared<const WorldSource>(
      WorldSource{world->written, world->keyframe, hash_sizes(*world->model)});
  world.reset();
}

Result<std::shared_ptr<const CompiledWorld>> RunRecord::Chapter::compiled() const {
  if (world != nullptr) return world;
  GLOAM_TRY(const World again, source->keyframe.empty()
                                   ? World::compile(source->scene)
                                   : World::compile_at(source->scene, source->keyframe));
  if (hash_sizes(*again.compiled()->model) == source->sizes) return again.compiled();
  return Error{
      ErrorKind::kInput,
      fmt::format("from step {} on the run was in another World, whose files have changed", from),
      {source->scene.file.string(), 0, 0},
      "restore the files that it was compiled from"};
}

}  // namespace gloam

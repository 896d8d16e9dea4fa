#include "world/compile/build_model.h"

#include <utility>

#include "world/compile/level.h"

namespace gloam {
namespace {

int first_body_of(const mjModel* model, const Level& level, const LevelRobot& robot) {
  int first = -1;
  const mjSpec* spec = level.spec.get();
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_BODY); e != nullptr;
       e = mjs_nextElement(spec, e)) {
    const int id = mjs_getId(e);
    if (mjs_getOriginSpec(e) == robot.spec.get() && id > 0 && (first < 0 || id < first)) first = id;
  }
  return first < model->nbody ? first : -1;
}

std::vector<RobotInstance> list_robots(const Level& level) {
  std::vector<RobotInstance> robots;
  for (const LevelRobot& robot : level.robots) {
    robots.push_back({robot.options.name, robot.options.name + "/",
                      first_body_of(level.model.get(), level, robot), robot.options});
  }
  return robots;
}

}  // namespace

Result<std::shared_ptr<CompiledWorld>> build_model(const ResolvedScene& resolved, ModelFiles* files,
                                                   CompileProgress* progress) {
  const Scene& scene = resolved.scene;
  GLOAM_TRY_STATUS(add_scene_files(scene, files));
  GLOAM_TRY(Level level, build_level(scene, resolved.place, resolved.objects, files, progress));
  auto world = std::make_shared<CompiledWorld>();
  world->scene = scene;
  world->place_hash = resolved.place_hash;
  world->robots = list_robots(level);
  world->model = std::move(level.model);
  world->initial_key = level.initial_key;
  world->notes = std::move(level.notes);
  world->unsupported = std::move(level.unsupported);
  world->lines = std::move(level.lines);
  return world;
}

}  // namespace gloam

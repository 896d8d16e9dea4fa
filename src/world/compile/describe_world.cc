#include "world/compile/describe_world.h"

#include <fmt/format.h>

#include <charconv>

#include "base/text.h"
#include "places/writer/place_writer.h"
#include "world/effects/gas_description.h"
#include "world/sensors/authored_lidar.h"
#include "world/sensors/hidden_bodies.h"
#include "world/sensors/sensor_description.h"
#include "world/view/render_origin.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

RobotInstance bare_robot(const Scene& scene, const mjModel* model) {
  RobotInstance robot;
  robot.name = scene.name;
  const std::vector<int> roots = robot_roots(*model);
  robot.root_body = !roots.empty() ? roots.front() : model->nbody > 1 ? 1 : -1;
  robot.options.name = scene.name;
  robot.options.file = scene.bare_model;
  return robot;
}

// Describes the parts of a place that are not in the model, and names its materials as in there.
void describe_place(const Place& place, CompiledWorld* world) {
  match_place_looks(place, *world->model, &world->scene);
  world->regions = place.regions;
  world->ev100 = place.ev100;
}

// Chooses the keyframe that a bare model starts from; a scene's robots name theirs. Cached models
// may have been stored with another keyframe.
Status choose_keyframe(const std::string& keyframe, CompiledWorld* world) {
  if (world->scene.bare_model.empty()) return {};
  world->initial_key = -1;
  if (keyframe.empty()) return {};
  const mjModel* m = world->model.get();
  const int count = static_cast<int>(m->nkey);
  world->initial_key = mj_name2id(m, mjOBJ_KEY, keyframe.c_str());
  if (world->initial_key >= 0) return {};
  int number = -1;
  const char* end = keyframe.data() + keyframe.size();
  const auto [after, code] = std::from_chars(keyframe.data(), end, number);
  if (code == std::errc() && after == end && number >= 0 && number < count) {
    world->initial_key = number;
    return {};
  }
  std::vector<std::string> names;
  for (const std::string& name : object_names(m, mjOBJ_KEY))
    if (!name.empty()) names.push_back(name);
  return Error{ErrorKind::kInput,
               fmt::format("the model has no keyframe '{}'", keyframe),
               {world->scene.bare_model.string(), 0, 0},
               !names.empty() ? suggest_name(keyframe, names)
               : count == 0
                   ? "it has no keyframes"
                   : fmt::format("its keyframes have no names: use a number, 0 to {}", count - 1)};
}

}  // namespace

Status describe_world(const ResolvedScene& resolved, const std::string& keyframe,
                      CompiledWorld* world) {
  world->written = resolved.written;
  world->keyframe = keyframe;
  world->drawn = resolved.drawn;
  world->place_notes = resolved.notes;
  if (resolved.place) describe_place(*resolved.place, world);
  if (!resolved.scene.bare_model.empty())
    world->robots = {bare_robot(resolved.scene, world->model.get())};
  GLOAM_TRY_STATUS(choose_keyframe(keyframe, world));
  GLOAM_TRY_STATUS(check_sensors(*world));
  GLOAM_TRY_STATUS(describe_lidars(*world));
  for (const CameraOptions& camera : world->scene.cameras)
    GLOAM_TRY_STATUS(hidden_bodies(*world->model, camera.hide,
                                   fmt::format("camera '{}'", camera.name), camera.loc));
  GLOAM_TRY(world->gases, describe_gases(*world));
  world->wind = describe_wind(world->scene, world->scene.weather.value_or(WeatherOptions{}));
  GLOAM_TRY(world->waters, describe_waters(world->scene));
  GLOAM_TRY(world->soils, describe_soils(world->scene, *world->model));
  GLOAM_TRY(world->agents, describe_agents(*world));
  GLOAM_TRY(world->probes, describe_probes(*world));
  world->render_origin = choose_render_origin(*world, &world->place_notes);
  return {};
}

}  // namespace gloam

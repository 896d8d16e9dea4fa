#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <span>

#include "base/memory.h"
#include "base/text.h"
#include "geometry/mesh/model_file.h"
#include "gloam/output_names.h"
#include "places/generators.h"
#include "places/writer/place_writer.h"
#include "scene/adversity.h"
#include "scene/files/mujoco_guard.h"
#include "scene/overcast.h"
#include "scene/randomize/randomize.h"
#include "scene/robots/robot_models.h"
#include "scene/validate/validate.h"
#include "world/cache/model_cache.h"
#include "world/compile/compile_progress.h"
#include "world/compile/level.h"
#include "world/compile/mesh_object.h"
#include "world/compile/rigs.h"
#include "world/compile/sampled_ground.h"
#include "world/effects/gas_description.h"
#include "world/sensors/authored_lidar.h"
#include "world/sensors/hidden_bodies.h"
#include "world/sensors/sensor_description.h"
#include "world/shapes/urdf_visuals.h"
#include "world/view/render_origin.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

// Below this a model compiles as fast as its cache entry is read.
constexpr std::chrono::milliseconds kWorthCaching{20};

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

// Notes requested sizes that exceed the limits of their kind of prop.
void note_sizes(const Scene& scene, const Place& place, std::vector<Error>* notes) {
  constexpr double kAbsoluteTolerance = 0.05, kRelativeTolerance = 0.1;  // [m], of the edge
  for (const PropOptions& prop : scene.props) {
    if (!prop.size) continue;
    for (const Placement& placement : place.placements()) {
      if (placement.name != prop.name) continue;
      const Prop::Box box = place.prop(placement.prop).bounds();
      const Vec3f made = box.high - box.low;
      const double edges[3][2] = {
          {prop.size->x, made.x}, {prop.size->y, made.y}, {prop.size->z, made.z}};
      std::string told;
      for (size_t i = 0; i < 3; ++i) {
        const auto [asked, is] = std::pair(edges[i][0], edges[i][1]);
        if (std::abs(asked - is) <= kAbsoluteTolerance + kRelativeTolerance * asked) continue;
        constexpr const char* kEdges[] = {"deep", "wide", "high"};
        told += fmt::format("{}{:.2f} m {}, not {:.4g} m", told.empty() ? "" : ", ", is, kEdges[i],
                            asked);
      }
      if (told.empty()) continue;
      notes->push_back(
          {ErrorKind::kInput, fmt::format("prop '{}': it is {}", prop.name, told), prop.loc,
           fmt::format("the closest possible size of a {}; `gloam props` lists typical sizes",
                       prop.kind)});
    }
  }
}

bool has_meshes(const Scene& scene) {
  return !scene.objects.empty() || is_model_file(scene.environment.file);
}

double weights_of(const Scene& scene) {
  return kModelWeight + (has_meshes(scene) ? kReadWeight + kConvertWeight : 0) +
         (scene.hfields.empty() ? 0 : kSampleWeight);
}

/// Describes all that refers to the compiled model.
Status describe_rest(CompiledWorld* world) {
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
  for (const std::string& name : object_names(m, mjOBJ_KEY, count))
    if (!name.empty()) names.push_back(name);
  return Error{ErrorKind::kInput,
               fmt::format("the model has no keyframe '{}'", keyframe),
               {world->scene.bare_model.string(), 0, 0},
               !names.empty() ? suggest_name(keyframe, names)
               : count == 0
                   ? "it has no keyframes"
                   : fmt::format("its keyframes have no names: use a number, 0 to {}", count - 1)};
}

// Channels among outputs become the outputs that a recording makes of them.
void expand_outputs(Scene* scene) {
  scene->record.outputs = recorded_outputs(scene->record.outputs);
  for (CameraOptions& camera : scene->cameras)
    if (camera.outputs) camera.outputs = recorded_outputs(*camera.outputs);
}

Result<World> compile_scene(const Scene& given, const std::string& keyframe,
                            const ProgressCallback& callback) {
  install_mujoco_handler();
  GLOAM_TRY(const Scene written, with_robot_models(given));
  GLOAM_TRY_STATUS(validate_scene(written));
  Scene scene = written;
  CompileProgress progress(callback, weights_of(scene));
  std::vector<DrawnOption> drawn;
  GLOAM_TRY_STATUS(draw_options(DrawStage::kPlace, &scene, &drawn));
  apply_adversity(&scene);
  if (has_generator(scene.environment)) progress.begin("generating the place", 0);
  GLOAM_TRY(std::optional<Place> place, make_place(scene));
  GLOAM_TRY_STATUS(progress.check());
  if (scene.weather && !scene.sky) {
    scene.sky = overcast_sky(*scene.weather);
    if (scene.sky && place && scene.environment.terrain) place->ev100 = overcast_ev100(*scene.sky);
  }
  if (place) {
    const size_t own = scene.lights.size();
    add_place_looks(*place, &scene);
    apply_adversity_to_lamps(scene, std::span(scene.lights).first(scene.lights.size() - own));
  }
  GLOAM_TRY_STATUS(add_ground_looks(&scene));
  if (has_meshes(scene)) progress.begin("reading model files", kReadWeight);
  GLOAM_TRY(const MeshObjects objects, load_mesh_objects(scene, &progress));
  GLOAM_TRY_STATUS(add_object_visuals(objects, &scene));
  GLOAM_TRY_STATUS(draw_options(DrawStage::kRest, &scene, &drawn));
  scene.randomize.clear();
  GLOAM_TRY(scene, with_rig_cameras(scene));
  expand_outputs(&scene);
  const uint64_t place_hash = (place ? place->hash() : 0) ^ objects.hash;
  std::vector<Error> sizes;
  if (place) note_sizes(scene, *place, &sizes);
  if (std::shared_ptr<CompiledWorld> cached = load_cached_world(scene, place_hash)) {
    if (place) describe_place(*place, cached.get());
    cached->drawn = drawn;
    cached->place_notes = std::move(sizes);
    if (!scene.bare_model.empty()) cached->robots = {bare_robot(scene, cached->model.get())};
    GLOAM_TRY_STATUS(choose_keyframe(keyframe, cached.get()));
    GLOAM_TRY_STATUS(describe_rest(cached.get()));
    cached->written = written;
    cached->keyframe = keyframe;
    progress.finish();
    return World(std::move(cached));
  }
  const auto start = std::chrono::steady_clock::now();
  ModelFiles files;
  GLOAM_TRY_STATUS(add_scene_files(scene, &files));
  GLOAM_TRY(Level level, build_level(scene, place, objects, &files, &progress));
  auto world = std::make_shared<CompiledWorld>();
  world->scene = scene;
  world->written = written;
  world->keyframe = keyframe;
  world->place_hash = place_hash;
  world->drawn = drawn;
  world->robots = list_robots(level);
  if (!scene.bare_model.empty()) world->robots = {bare_robot(scene, level.model.get())};
  world->model = std::move(level.model);
  if (place) describe_place(*place, world.get());
  world->initial_key = level.initial_key;
  GLOAM_TRY_STATUS(choose_keyframe(keyframe, world.get()));
  world->notes = std::move(level.notes);
  world->place_notes = std::move(sizes);
  world->unsupported = std::move(level.unsupported);
  world->lines = std::move(level.lines);
  GLOAM_TRY_STATUS(describe_rest(world.get()));
  add_urdf_visuals(scene, &files, world.get());
  world->files = files.dependencies();
  if (std::chrono::steady_clock::now() - start > kWorthCaching)
    store_cached_world(world, world->files);
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

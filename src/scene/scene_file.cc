#include "base/files.h"
#include "base/plain_text.h"
#include "geometry/mesh/model_file.h"
#include "gloam/options.h"
#include "gloam/scene.h"
#include "places/generators.h"
#include "scene/files/file_finder.h"
#include "scene/robots/robot_models.h"
#include "scene/toml/overlay.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate/validate.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kLargestScene = uint64_t{4} << 20;

Status find_files(const FileFinder& finder, Scene* scene) {
  EnvironmentOptions& place = scene->environment;
  GLOAM_TRY_STATUS(is_model_file(place.file) ? finder.find(&place.file, place.loc)
                                             : finder.find_model(&place.file, place.loc));
  for (ObjectOptions& object : scene->objects)
    GLOAM_TRY_STATUS(finder.find(&object.file, object.loc));
  for (RobotOptions& robot : scene->robots) {
    GLOAM_TRY_STATUS(finder.find_model(&robot.file, robot.loc));
    for (ActuatorOptions& actuator : robot.actuator)
      if (actuator.network) GLOAM_TRY_STATUS(finder.find(&actuator.network->file, actuator.loc));
  }
  for (VisualOptions& visual : scene->visuals)
    GLOAM_TRY_STATUS(finder.find(&visual.file, visual.loc));
  for (HeightFieldOptions& hfield : scene->hfields)
    GLOAM_TRY_STATUS(finder.find(&hfield.file, hfield.loc));
  for (MaterialOptions& material : scene->materials) {
    for (auto* map : {&material.bump, &material.coat_weight_map, &material.coat_roughness_map,
                      &material.transmission_weight_map}) {
      GLOAM_TRY_STATUS(finder.find(map, material.loc));
    }
  }
  for (LightOptions& light : scene->lights) {
    GLOAM_TRY_STATUS(finder.find(&light.file, light.loc));
    GLOAM_TRY_STATUS(finder.find(&light.ies, light.loc));
  }
  for (AgentOptions& agent : scene->agents) GLOAM_TRY_STATUS(finder.find(&agent.tree, agent.loc));
  if (scene->sky) GLOAM_TRY_STATUS(finder.find(&scene->sky->file, scene->sky->loc));
  if (scene->planner) {
    PlannerOptions& planner = *scene->planner;
    GLOAM_TRY_STATUS(finder.find_file_or_folder(&planner.map, planner.loc));
    GLOAM_TRY_STATUS(finder.find_file_or_folder(&planner.weights, planner.loc));
    GLOAM_TRY_STATUS(finder.find(&planner.library, planner.loc));
  }
  for (VolumeOptions& volume : scene->volumes) {
    GLOAM_TRY_STATUS(finder.find(&volume.grid, volume.loc));
    GLOAM_TRY_STATUS(finder.find(&volume.temperature_grid, volume.loc));
  }
  return {};
}

}  // namespace

namespace {

Result<Scene> read_scene(toml::table table, const fs::path& path, Scene scene) {
  scene.file = path;
  GLOAM_TRY(const FileFinder finder, FileFinder::of_scene(path, scene.access));
  GLOAM_TRY_STATUS(expand_robot_models(finder, scene.access, path.string(), &table));
  GLOAM_TRY_STATUS(read_scene_toml(table, path.string(), &scene));
  GLOAM_TRY_STATUS(find_files(finder, &scene));
  GLOAM_TRY_STATUS(validate_scene(scene));
  if (scene.robots.empty() && scene.environment.file.empty() && !has_generator(scene.environment) &&
      scene.props.empty() && scene.visuals.empty() && scene.objects.empty() &&
      scene.hfields.empty() && scene.agents.empty() && scene.crowds.empty() &&
      scene.bare_model.empty()) {
    return Error{ErrorKind::kInput,
                 "the scene is empty",
                 {path.string(), 0, 0},
                 "add at least one [[robot]], [[object]], [[visual]] or an [environment]"};
  }
  return scene;
}

}  // namespace

Result<Scene> load_scene(const fs::path& path, const FileAccess& access) {
  Scene scene;
  scene.access = access;
  scene.name = path.stem().string();
  const auto as_bare_model = [&] {
    scene.bare_model = absolute_path(path, "");
    return scene;
  };
  if (lower_extension(path) != ".toml") {
    GLOAM_TRY_STATUS(check_model_file(absolute_path(path, ""), path.string(), {}));
    return as_bare_model();
  }
  Result<std::string> text = read_plain_text(path, kLargestModelText);
  if (!text.ok()) {
    Error error = std::move(text).error();
    std::error_code code;
    if (!fs::exists(path, code)) error.hint = suggest_file(absolute_path(path, ""));
    return error;
  }
  GLOAM_TRY(toml::table table, parse_toml(*text, path.string()));
  if (is_model_toml(table)) return as_bare_model();
  if (text->size() > kLargestScene)
    return Error{ErrorKind::kInput, "the scene is larger than 4 MiB", {path.string(), 0, 0}};
  return read_scene(std::move(table), path, std::move(scene));
}

Result<Scene> parse_scene(std::string_view text, const fs::path& folder, const FileAccess& access) {
  const fs::path path = folder / "scene.toml";  // need not exist: files are found from there
  if (text.size() > kLargestScene)
    return Error{ErrorKind::kInput, "the scene is larger than 4 MiB"};
  GLOAM_TRY(const std::optional<std::string> plain, plain_text(text, path.string()));
  GLOAM_TRY(toml::table table, parse_toml(plain ? *plain : std::string(text), path.string()));
  Scene scene;
  scene.access = access;
  scene.name = "scene";
  return read_scene(std::move(table), path, std::move(scene));
}

Result<Scene> overlay_scene(const Scene& scene, std::string_view text, const std::string& file) {
  if (text.size() > kLargestScene)
    return Error{ErrorKind::kInput, "the scene is larger than 4 MiB", {file, 0, 0}};
  GLOAM_TRY(const std::optional<std::string> plain, plain_text(text, file));
  GLOAM_TRY(toml::table over, parse_toml(plain ? *plain : std::string(text), file));
  const fs::path path = scene.file.empty() ? fs::path("scene.toml") : scene.file;
  GLOAM_TRY(toml::table table, parse_toml(to_toml(scene), path.string()));
  forget_other_models(over, &table);
  overlay_table(std::move(over), &table);
  Scene changed;
  changed.access = scene.access;
  changed.name = scene.name;
  changed.bare_model = scene.bare_model;
  return read_scene(std::move(table), path, std::move(changed));
}

Result<Scene> overlay_scene(const Scene& scene, const fs::path& file) {
  GLOAM_TRY(const std::string text, read_plain_text(file, kLargestScene));
  return overlay_scene(scene, text, file.string());
}

}  // namespace gloam

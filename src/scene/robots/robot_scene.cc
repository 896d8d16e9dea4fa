#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/files.h"
#include "scene/robots/mounted_sensor.h"
#include "scene/robots/robot_entry.h"
#include "scene/robots/robot_models.h"
#include "scene/toml/table_writer.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

bool has_model(const RobotOptions& robot) { return !robot.model.empty() || !robot.sensors.empty(); }

/// The options that are given, as a [[robot]]. A controller without a type has the model's.
toml::table table_of(RobotOptions robot) {
  const bool has_type = robot.controller.type != ControllerOptions().type;
  if (!has_type) robot.controller.type.clear();  // a type that is not known has all options
  toml::table table = TableWriter::table_of(robot, fs::path());
  toml::table* controller = table.get_as<toml::table>("controller");
  if (controller == nullptr || has_type) return table;
  controller->erase("type");
  if (controller->empty()) table.erase("controller");
  return table;
}

/// The robot's [[robot]] and the sections of its sensors, expanded.
Result<Scene> expanded(const Scene& scene, const RobotOptions& robot) {
  RobotOptions given = robot;
  fs::path from = scene.file.empty() ? fs::path("scene.toml") : scene.file;
  if (scene.file.empty() && is_robot_path(robot.model)) {
    // A path in a Scene that was made in code is the program's own, as `file` is.
    from = absolute_path(robot.model, "");
    given.model = from.string();
    if (lower_extension(from) != ".toml") from /= kRobotEntryFile;
  }
  toml::array robots;
  robots.push_back(table_of(std::move(given)));
  toml::table table;
  table.insert_or_assign("robot", std::move(robots));
  const std::string label;  // of what is in no file
  GLOAM_TRY(const FileFinder finder, FileFinder::of_scene(from, scene.access));
  Scene out;
  Status status = expand_robot_models(finder, scene.access, label, &table);
  if (status.ok()) status = read_scene_toml(table, label, &out);
  if (status.ok()) return out;
  Error error = status.error();
  if (error.loc.file.empty()) error.loc = robot.loc;
  return error;
}

}  // namespace

Result<Scene> with_robot_models(const Scene& scene) {
  Scene out = scene;
  for (RobotOptions& robot : out.robots) {
    if (!has_model(robot)) continue;
    GLOAM_TRY(Scene part, expanded(scene, robot));
    part.robots[0].loc = robot.loc;
    robot = std::move(part.robots[0]);
    visit_mounted(out, part, [](auto& to, auto& from) {
      to.insert(to.end(), std::make_move_iterator(from.begin()),
                std::make_move_iterator(from.end()));
    });
  }
  return out;
}

}  // namespace gloam

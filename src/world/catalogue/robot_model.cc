// gloam/scene/robot_model.h: the catalogue.

#include <fmt/format.h>

#include "base/plain_text.h"
#include "gloam/scene.h"
#include "gloam/world.h"
#include "scene/files/model_path.h"
#include "scene/robots/robot_entry.h"
#include "world/world.h"

namespace gloam {
namespace {

void measure(const CompiledWorld& world, RobotModelInfo* info) {
  const mjModel& m = *world.model;
  for (int joint = 0; joint < static_cast<int>(m.njnt); ++joint)
    if (m.jnt_type[joint] == mjJNT_FREE)
      info->is_floating = true;
    else
      ++info->joints;
  info->actuators = static_cast<int>(m.nactuator);
  info->mass = mj_getTotalmass(&m);
}

}  // namespace

Result<RobotModelInfo> robot_model(const std::string& model, const FileAccess& access) {
  GLOAM_TRY(const std::filesystem::path found, find_robot_entry(model, {}));
  const std::filesystem::path file = absolute_path(found, "");
  GLOAM_TRY(const std::string text, read_plain_text(file, kLargestRobotEntry));
  GLOAM_TRY(RobotEntry entry, parse_robot_entry(text, file, access));
  RobotModelInfo info{.name = entry.name, .description = entry.description, .file = file};
  Scene scene;
  scene.access = access;
  scene.robots.push_back({.name = "robot", .model = file.string()});
  for (const SensorTemplate& sensor : entry.sensors) {
    info.sensors.push_back({sensor.name, sensor.kind});
    scene.robots[0].sensors.push_back(sensor.name);
  }
  GLOAM_TRY(const World world, World::compile(scene));
  info.defaults = world.compiled()->written.robots.at(0);
  info.defaults.name.clear();
  measure(*world.compiled(), &info);
  return info;
}

Result<std::vector<RobotModelInfo>> robot_models() {
  std::vector<RobotModelInfo> list;
  for (const std::string& name : catalogue_names()) {
    GLOAM_TRY(list.emplace_back(), robot_model(name));
  }
  return list;
}

}  // namespace gloam

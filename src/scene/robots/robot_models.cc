#include "scene/robots/robot_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/plain_text.h"
#include "base/text.h"
#include "scene/robots/mounted_sensor.h"
#include "scene/robots/robot_entry.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kMostEntryText = uint64_t{64} << 20;  // of all robots of a scene [bytes]

void fill_from(toml::table&& defaults, toml::table* own) {
  for (auto&& [key, node] : defaults) {
    toml::node* given = own->get(key);
    if (given == nullptr)
      own->insert_or_assign(key, std::move(node));
    else if (given->is_table() && node.is_table())
      fill_from(std::move(*node.as_table()), given->as_table());
  }
}

// Settings of another type of controller do not apply. The rate depends on the model's time step.
void drop_other_controller(const toml::table& own, toml::table* entry) {
  toml::table* defaults = entry->get_as<toml::table>("controller");
  const auto type = own["controller"]["type"].value<std::string>();
  if (defaults == nullptr || !type || (*defaults)["type"].value<std::string>() == type) return;
  std::vector<std::string> dropped;
  for (const auto& [key, node] : *defaults)
    if (key != "rate") dropped.emplace_back(key.str());
  for (const std::string& key : dropped) defaults->erase(key);
}

// `actuator = []` leaves out the models of actuators, and with them their battery.
void drop_unused_supply(const toml::table& own, toml::table* entry) {
  const toml::array* actuators = own["actuator"].as_array();
  if (actuators != nullptr && actuators->empty()) entry->erase("actuators");
}

void add_prefix(const std::string& prefix, toml::node* node) {
  if (toml::value<std::string>* text = node->as_string()) text->get().insert(0, prefix);
  if (toml::array* list = node->as_array())
    for (toml::node& item : *list) add_prefix(prefix, &item);
}

/// Makes a section of the scene of a template. Names of the robot's own parts become full names.
toml::table mounted(toml::table table, const std::string& section, const std::string& robot) {
  const auto& kind = *std::ranges::find(kMountedKinds, section, &MountedKind::section);
  const std::string prefix = robot + "/";
  for (const char* key : {"name", "mount", "hide"})
    if (toml::node* node = table.get(key)) add_prefix(prefix, node);
  if (const auto mount = table.find("mount"); mount != table.end()) {
    toml::node& node = mount->second;
    table.insert_or_assign(kind.parent, std::move(node));
    table.erase("mount");
  }
  if (!kind.has_name) table.erase("name");
  return table;
}

// Moves the listed sensors to the scene's sections.
Status add_sensors(const toml::node& listed, const std::string& robot, const std::string& file,
                   std::vector<SensorTemplate> sensors, toml::table* scene) {
  const toml::array* wanted = listed.as_array();
  if (wanted == nullptr)
    return Error{ErrorKind::kInput, "'sensors' must be an array of names", loc_of(listed, file)};
  std::vector<std::string> names, added;
  for (const SensorTemplate& sensor : sensors) names.push_back(sensor.name);
  for (const toml::node& item : *wanted) {
    const auto sensor = item.value_or(std::string());
    const auto found = std::ranges::find(sensors, sensor, &SensorTemplate::name);
    if (found == sensors.end())
      return Error{ErrorKind::kInput,
                   fmt::format("robot '{:.80}' has no sensor '{:.80}'", robot, sensor),
                   loc_of(item, file),
                   names.empty() ? "its model has no sensors" : suggest_name(sensor, names)};
    if (std::ranges::find(added, sensor) != added.end())
      return Error{ErrorKind::kInput, fmt::format("'sensors' lists '{:.80}' twice", sensor),
                   loc_of(item, file)};
    added.push_back(sensor);
    const std::string section = found->kind;
    if (!scene->contains(section)) scene->insert_or_assign(section, toml::array());
    toml::array* list = scene->get_as<toml::array>(section);
    if (list != nullptr) list->push_back(mounted(std::move(found->table), section, robot));
  }
  return {};
}

class ModelExpander {
 public:
  ModelExpander(const FileFinder& finder, const FileAccess& access, const std::string& file,
                toml::table* scene)
      : finder_(finder), access_(access), file_(file), scene_(scene) {}

  Status expand(toml::table* robot) {
    const toml::node* node = robot->get("model");
    if (node == nullptr) {
      const toml::node* sensors = robot->get("sensors");
      if (sensors == nullptr) return {};
      return Error{ErrorKind::kInput, "a robot has 'sensors' but no 'model'",
                   loc_of(*sensors, file_),
                   "add them as [[camera]], [[lidar]] …, or give a 'model' of `gloam robots`"};
    }
    const auto model = node->value_exact<std::string>();
    if (!model || model->empty()) return {};  // the reader's error
    if (const toml::node* file = robot->get("file"))
      return Error{ErrorKind::kInput, "a robot has both 'model' and 'file'", loc_of(*file, file_),
                   "specify only one of them"};
    GLOAM_TRY(RobotEntry entry, find(*model, loc_of(*node, file_)));
    return merge_robot_entry(std::move(entry), file_, robot, scene_);
  }

 private:
  Result<RobotEntry> find(const std::string& model, const SourceLoc& loc) {
    GLOAM_TRY(fs::path path, find_robot_entry(model, loc));
    if (is_robot_path(model)) GLOAM_TRY_STATUS(finder_.find(&path, loc));
    auto known = texts_.find(path);
    if (known == texts_.end()) {
      GLOAM_TRY(std::string text, read_plain_text(path, kLargestRobotEntry));
      known = texts_.emplace(path, std::move(text)).first;
    }
    parsed_ += known->second.size();
    if (parsed_ > kMostEntryText)
      return Error{ErrorKind::kInput,
                   "the robot.toml files of all robots together are larger than 64 MiB", loc};
    return parse_robot_entry(known->second, path, access_);
  }

  const FileFinder& finder_;
  const FileAccess& access_;
  const std::string& file_;
  toml::table* scene_;
  std::map<fs::path, std::string> texts_;
  uint64_t parsed_ = 0;  // [bytes]
};

// True if `over` gives the robot `name` another model or file.
bool replaces_model(const toml::table& over, const std::string& name) {
  const toml::array* robots = over["robot"].as_array();
  return robots != nullptr && std::ranges::any_of(*robots, [&name](const toml::node& node) {
           const toml::table* robot = node.as_table();
           return robot != nullptr && (*robot)["name"].value<std::string>() == name &&
                  (robot->contains("model") || robot->contains("file"));
         });
}

}  // namespace

Status merge_robot_entry(RobotEntry entry, const std::string& file, toml::table* robot,
                         toml::table* scene) {
  if (!robot->contains("name") || (*robot)["name"] == "")
    robot->insert_or_assign("name", entry.name);
  const std::string name = (*robot)["name"].value_or(std::string());
  if (const toml::node* sensors = robot->get("sensors"))
    GLOAM_TRY_STATUS(add_sensors(*sensors, name, file, std::move(entry.sensors), scene));
  robot->erase("model");
  robot->erase("sensors");
  drop_other_controller(*robot, &entry.robot);
  drop_unused_supply(*robot, &entry.robot);
  fill_from(std::move(entry.robot), robot);
  return {};
}

void forget_other_models(const toml::table& over, toml::table* scene) {
  toml::array* robots = scene->get_as<toml::array>("robot");
  if (robots == nullptr) return;
  for (toml::node& node : *robots) {
    toml::table* robot = node.as_table();
    if (robot == nullptr || !replaces_model(over, (*robot)["name"].value_or(std::string())))
      continue;
    toml::table kept;
    for (const char* key : {"name", "position", "orientation"})
      if (toml::node* value = robot->get(key)) kept.insert_or_assign(key, std::move(*value));
    *robot = std::move(kept);
  }
}

Status expand_robot_models(const FileFinder& finder, const FileAccess& access,
                           const std::string& file, toml::table* scene) {
  toml::array* robots = scene->get_as<toml::array>("robot");
  if (robots == nullptr) return {};
  ModelExpander expander(finder, access, file, scene);
  for (toml::node& robot : *robots)
    if (toml::table* table = robot.as_table()) GLOAM_TRY_STATUS(expander.expand(table));
  return {};
}

}  // namespace gloam

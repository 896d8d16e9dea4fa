#include "scene/robots/robot_entry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/files.h"
#include "base/text.h"
#include "scene/files/file_finder.h"
#include "scene/files/model_path.h"
#include "scene/robots/mounted_sensor.h"
#include "scene/robots/path_anchor.h"
#include "scene/toml/toml_reader.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::string_view, 3> kNotOfARobot = {"name", "model", "sensors"};

class EntryReader {
 public:
  EntryReader(const fs::path& file, const FileAccess& access)
      : file_(file), label_(file.string()), access_(access) {}

  Result<RobotEntry> read(toml::table table) {
    RobotEntry entry;
    entry.file = file_;
    entry.name = file_.filename() == kRobotEntryFile ? file_.parent_path().filename().string()
                                                     : file_.stem().string();
    for (const std::string_view key : kNotOfARobot)
      if (const auto found = table.find(key); found != table.end())
        return Error{ErrorKind::kInput, fmt::format("'{}' is set by the scene", key),
                     loc_of(found->first, label_), "remove it from the robot's file"};
    GLOAM_TRY(entry.description, text_of(table, "description", "the robot's file"));
    table.erase("description");
    if (toml::node* sensors = table.get("sensor")) {
      toml::array* list = sensors->as_array();
      if (list == nullptr) return wrong_type(*sensors, "sensor", "an array of tables");
      for (toml::node& node : *list) GLOAM_TRY_STATUS(read_sensor(&node, &entry.sensors));
      table.erase("sensor");
    }
    GLOAM_TRY_STATUS(find_model(&table));
    entry.robot = std::move(table);
    return entry;
  }

 private:
  Error wrong_type(const toml::node& node, std::string_view key, std::string_view wanted) const {
    return {ErrorKind::kInput, fmt::format("'{}' must be {}", key, wanted), loc_of(node, label_)};
  }

  Result<std::string> text_of(const toml::table& table, std::string_view key,
                              std::string_view where) const {
    const toml::node* node = table.get(key);
    if (node == nullptr)
      return Error{ErrorKind::kInput, fmt::format("'{}' is missing in {}", key, where),
                   loc_of(table, label_)};
    const auto text = node->value_exact<std::string>();
    if (!text || text->empty()) return wrong_type(*node, key, "a string that is not empty");
    return *text;
  }

  Status read_sensor(toml::node* node, std::vector<SensorTemplate>* out) const {
    toml::table* table = node->as_table();
    if (table == nullptr) return wrong_type(*node, "sensor", "an array of tables");
    SensorTemplate sensor;
    GLOAM_TRY(sensor.name, text_of(*table, "name", "[[sensor]]"));
    GLOAM_TRY(sensor.kind, text_of(*table, "kind", "[[sensor]]"));
    const auto kind = std::ranges::find(kMountedKinds, sensor.kind, &MountedKind::section);
    if (kind == kMountedKinds.end()) {
      std::vector<std::string> kinds;
      for (const MountedKind& known : kMountedKinds) kinds.emplace_back(known.section);
      return Error{ErrorKind::kInput,
                   fmt::format("sensor '{:.80}' cannot be a '{:.80}'", sensor.name, sensor.kind),
                   loc_of(*table->get("kind"), label_), suggest_name(sensor.kind, kinds)};
    }
    if (const toml::node* parent = table->get(kind->parent))
      return Error{ErrorKind::kInput,
                   fmt::format("sensor '{:.80}' has '{}'", sensor.name, kind->parent),
                   loc_of(*parent, label_), "use 'mount', without the robot's prefix"};
    const bool is_known = std::ranges::find(*out, sensor.name, &SensorTemplate::name) != out->end();
    if (is_known || sensor.name.find('/') != std::string::npos)
      return Error{ErrorKind::kInput,
                   is_known ? fmt::format("there are two sensors named '{:.80}'", sensor.name)
                            : fmt::format("the sensor '{:.80}' has a '/' in its name", sensor.name),
                   loc_of(*table->get("name"), label_)};
    table->erase("kind");
    PathAnchor(file_.parent_path()).anchor_section(sensor.kind, table);
    sensor.table = std::move(*table);
    out->push_back(std::move(sensor));
    return {};
  }

  // The model's file, which a stranger's robot.toml could choose freely.
  Status find_model(toml::table* table) const {
    GLOAM_TRY(const std::string written, text_of(*table, "file", "the robot's file"));
    PathAnchor(file_.parent_path()).anchor_robot(table);
    GLOAM_TRY(const FileFinder finder, FileFinder::of_scene(file_, access_));
    fs::path path = written;
    toml::value<std::string>* file = table->get_as<std::string>("file");
    GLOAM_TRY_STATUS(finder.find_model(&path, loc_of(*file, label_)));
    file->get() = path.string();
    return {};
  }

  const fs::path& file_;
  const std::string label_;
  const FileAccess& access_;
};

}  // namespace

Result<RobotEntry> parse_robot_entry(std::string_view text, const fs::path& file,
                                     const FileAccess& access) {
  GLOAM_TRY(toml::table table, parse_toml(text, file.string()));
  return EntryReader(file, access).read(std::move(table));
}

bool is_robot_path(std::string_view model) {
  return model.find('/') != std::string_view::npos || lower_extension(fs::path(model)) == ".toml";
}

std::vector<std::string> catalogue_names() {
  const fs::path folder = catalogue_folder();
  std::vector<std::string> names;
  std::error_code code;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
    std::error_code other;
    if (fs::is_regular_file(it->path() / kRobotEntryFile, other))
      names.push_back(it->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

Result<fs::path> find_robot_entry(const std::string& model, const SourceLoc& loc) {
  const fs::path path = model;
  if (is_robot_path(model)) return lower_extension(path) == ".toml" ? path : path / kRobotEntryFile;
  const std::vector<std::string> names = catalogue_names();
  if (std::ranges::find(names, model) != names.end())
    return catalogue_folder() / model / kRobotEntryFile;
  return Error{ErrorKind::kInput, fmt::format("there is no robot model '{:.80}'", model), loc,
               names.empty() ? "Gloam's own robots were not found: set GLOAM_HOME"
                             : suggest_name(model, names)};
}

}  // namespace gloam

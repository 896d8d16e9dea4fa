#pragma once
// robot.toml: the settings of a [[robot]] and templates of its sensors (docs/robots.md). The
// catalogue is the folders of assets/robots/ that hold one; others may come from strangers.

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

inline constexpr const char* kRobotEntryFile = "robot.toml";

/// One [[sensor]] of a robot.toml.
struct SensorTemplate {
  std::string name, kind;  ///< kind: a section of kMountedKinds
  toml::table table;       ///< without `kind`
};

struct RobotEntry {
  std::string name;            ///< of its folder
  std::filesystem::path file;  ///< absolute
  std::string description;
  toml::table robot;  ///< keys of [[robot]]; paths are absolute
  std::vector<SensorTemplate> sensors;
};

/// Reads the text of a robot.toml. Paths in it start from its folder; `access` limits the files
/// that it may name, as if it were a scene. Errors: syntax, an unknown key, no `file`, a file that
/// it may not read or that is no model, a sensor without name or of an unknown kind. Values of
/// other keys are checked where they are used.
Result<RobotEntry> parse_robot_entry(std::string_view text, const std::filesystem::path& file,
                                     const FileAccess& access);

/// Largest robot.toml [bytes].
inline constexpr uint64_t kLargestRobotEntry = uint64_t{1} << 18;

/// True if `model` of a [[robot]] is a path, not a name of the catalogue.
bool is_robot_path(std::string_view model);

/// Folders of the catalogue by their names, sorted: all of gloam_home()/assets/robots that hold a
/// robot.toml. Empty where there is none.
std::vector<std::string> catalogue_names();

/// The robot.toml of a name of the catalogue, or of a path of it or its folder, as written. Error:
/// the catalogue has no such name, at `loc`.
Result<std::filesystem::path> find_robot_entry(const std::string& model, const SourceLoc& loc);

}  // namespace gloam

#pragma once
// Access to the options of a Scene by path, and to whole Scenes as text.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

class World;  // gloam/world.h

/// Returns the original Scene of a World: World::scene() without additions by generators and random
/// draws. It can be changed and compiled again.
Scene written_scene(const World& world);

/// Returns the options of a Scene that differ from their defaults, as a scene file.
/// parse_scene(text, scene.file.parent_path()) returns the same Scene; paths of files in that
/// folder are relative to it. A bare model is not an option: keep Scene::bare_model together with
/// the text.
std::string to_toml(const Scene& scene);

/// Returns one option as TOML: "0.5", "[0, 0, 1]", "'fast'". `path` as in set_option; if a pattern
/// matches several options, the first. Errors: no such option; the path is a whole table.
Result<std::string> get_option(const Scene& scene, std::string_view path);

struct OptionInfo {
  std::string path;                       ///< path for set_option
  std::string value;                      ///< as TOML; empty = not given
  std::string unit;                       ///< "" = none or text
  double low, high;                       ///< range of its numbers; infinite = no limit
  std::vector<std::string> choices = {};  ///< allowed values; empty = any
};

/// All options of the tables that a Scene contains, in the order of scene_schema().
std::vector<OptionInfo> list_options(const Scene& scene);

/// Returns a Scene changed by the text of a second scene file: its options replace options of the
/// Scene; its list tables ([[camera]], [[light]] …) change tables of the same name and add the
/// others. `file` is its name in errors; relative paths start from the Scene's folder. Errors: as
/// for parse_scene.
Result<Scene> overlay_scene(const Scene& scene, std::string_view toml, const std::string& file);
/// The same for a file.
Result<Scene> overlay_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace gloam

#pragma once
// Options of a Scene by their paths, and whole Scenes as text.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

class World;  // gloam/world.h

/// The Scene that a World was compiled from, as it was given: World::scene() without what
/// generators and draws added. Changed, it compiles again.
Scene written_scene(const World& world);

/// The options of a Scene as a scene file: those that differ from their defaults. parse_scene(text,
/// scene.file.parent_path()) gives the same Scene again; files are named from there where they lie
/// below it. A bare model is no option: keep Scene::bare_model beside the text.
std::string to_toml(const Scene& scene);

/// One option as TOML: "0.5", "[0, 0, 1]", "'fast'". `path` as of set_option; of several that a
/// pattern fits, the first. Errors: there is no such option; it is a whole table.
Result<std::string> get_option(const Scene& scene, std::string_view path);

struct OptionInfo {
  std::string path;                       ///< as set_option takes it
  std::string value;                      ///< as TOML; empty = not given
  std::string unit;                       ///< "" = none or text
  double low, high;                       ///< of its numbers; infinite = no limit
  std::vector<std::string> choices = {};  ///< closed list of words; empty = any
};

/// All options of the tables that stand in a Scene, in the order of scene_schema().
std::vector<OptionInfo> list_options(const Scene& scene);

/// A Scene changed by the text of a second scene file: its options replace those of the Scene; its
/// list tables ([[camera]], [[light]] …) change those of the same name and add the others. `file`
/// names it in errors; relative paths start from the Scene's folder. Errors: those of parse_scene.
Result<Scene> overlay_scene(const Scene& scene, std::string_view toml, const std::string& file);
/// The same of a file.
Result<Scene> overlay_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace gloam

#pragma once
// Files that a scene names: where they are, and whether the scene may read them.

#include <filesystem>
#include <string>
#include <vector>

#include "scene/files/model_path.h"
#include "scene/toml/toml_reader.h"

namespace gloam {

/// Nearest name in the folder of a file that is not there, as a hint.
std::string suggest_file(const std::filesystem::path& missing);

/// True if the text is a model in TOML, not a scene: all of it is below [mujoco].
bool is_model_toml(const toml::table& table);

/// Errors: no such file, no plain file; by its name a scene or an archive.
Status check_model_file(const std::filesystem::path& path, const std::string& as_written,
                        const SourceLoc& loc);

class FileFinder {
 public:
  /// Errors: the scene is not inside the root that the user gave.
  static Result<FileFinder> of_scene(const std::filesystem::path& scene_file,
                                     const FileAccess& access);

  /// Makes a path of the scene absolute and refuses it if it leaves the scene's root and Gloam's
  /// own robots. No path, no file.
  Status find(std::filesystem::path* file, const SourceLoc& loc) const;
  /// `find` for a path that may also be a folder, all of whose files are then readable.
  Status find_file_or_folder(std::filesystem::path* path, const SourceLoc& loc) const;
  /// `find` and check_model_file.
  Status find_model(std::filesystem::path* file, const SourceLoc& loc) const;

 private:
  Status resolve(std::filesystem::path* file, const std::string& written,
                 const SourceLoc& loc) const;

  std::filesystem::path folder_;
  std::vector<ModelRoot> roots_;
};

}  // namespace gloam

#include <fmt/format.h>

#include <algorithm>

#include "base/files.h"
#include "base/text.h"
#include "gloam/scene.h"
#include "scene/mjcf/model_text.h"
#include "scene/model_path.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kLargestScene = uint64_t{4} << 20;
constexpr uint64_t kLargestModel = uint64_t{64} << 20;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Names in the folder of `missing` that it may have been meant to be.
std::string suggest_file(const fs::path& missing) {
  constexpr size_t kMostFiles = 1000;
  std::vector<std::string> names;
  std::error_code code;
  for (fs::directory_iterator it(missing.parent_path(), code), end; !code && it != end;
       it.increment(code)) {
    names.push_back(it->path().filename().string());
    if (names.size() >= kMostFiles) break;
  }
  std::sort(names.begin(), names.end());
  const std::string near = nearest_name(missing.filename().string(), names);
  return near.empty() ? "check the path" : fmt::format("did you mean '{}'?", near);
}

Status check_file(const fs::path& path, const std::string& as_written, const SourceLoc& loc) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  const std::string name = as_written.substr(0, 200);
  if (!fs::exists(status))
    return Error{ErrorKind::kInput, fmt::format("there is no file '{}'", name), loc,
                 suggest_file(path)};
  if (!fs::is_regular_file(status))
    return Error{ErrorKind::kInput, fmt::format("'{}' is not a file", name), loc};
  return {};
}

// check_file, and by its name it is no scene and no archive.
Status check_model_file(const fs::path& path, const std::string& as_written, const SourceLoc& loc) {
  GLOAM_TRY_STATUS(check_file(path, as_written, loc));
  const std::string name = as_written.substr(0, 200);
  const std::string extension = lower(path.extension().string());
  if (extension == ".toml") {
    GLOAM_TRY(const std::string text, read_text_file(path, kLargestModel));
    if (is_model_toml(text)) return {};
    return Error{ErrorKind::kInput, fmt::format("'{}' is a scene; a model is wanted here", name),
                 loc, "give an MJCF (.xml) or URDF file, or a model in TOML (docs/models.md)"};
  }
  if (extension == ".mjz" || extension == ".zip" || extension == ".mjb") {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("'{}' is an archive or binary model, which is not read", name), loc,
                 "give the MJCF (.xml) or URDF file"};
  }
  return {};
}

// Finds the files that a scene names.
class FileFinder {
 public:
  FileFinder(const fs::path& scene_file, const ModelRoot& root, const FileAccess& access)
      : folder_(absolute_path(scene_file, "").parent_path()), roots_{root} {
    for (const auto& [name, folder] : access.packages) {
      std::error_code code;
      const fs::path canonical = fs::weakly_canonical(folder, code);
      roots_.push_back({absolute_path(folder, ""), canonical, canonical});
    }
  }

  // Makes a path of the scene absolute and refuses it if it leaves the scene's root. No path, no
  // file.
  Status find(fs::path* file, const SourceLoc& loc) const {
    if (file->empty()) return {};
    const std::string written = file->string();
    GLOAM_TRY_STATUS(resolve(file, written, loc));
    return check_file(*file, written, loc);
  }
  Status find_model(fs::path* file, const SourceLoc& loc) const {
    if (file->empty()) return {};
    const std::string written = file->string();
    GLOAM_TRY_STATUS(resolve(file, written, loc));
    return check_model_file(*file, written, loc);
  }

 private:
  Status resolve(fs::path* file, const std::string& written, const SourceLoc& loc) const {
    const std::string refusal = why_not_a_path(written);
    if (!refusal.empty())
      return Error{ErrorKind::kInput, fmt::format("the file '{:.80}' {}", written, refusal), loc};
    const fs::path path = absolute_path(*file, folder_);
    const std::string why = why_not_readable(path, roots_);
    if (!why.empty()) {
      return Error{ErrorKind::kInput, fmt::format("the file '{:.200}' {}", written, why), loc,
                   "--root FOLDER widens what the scene may read"};
    }
    *file = path;
    return {};
  }

  fs::path folder_;
  std::vector<ModelRoot> roots_;
};

Status find_files(const FileFinder& finder, Scene* scene) {
  GLOAM_TRY_STATUS(finder.find_model(&scene->environment.file, scene->environment.loc));
  for (RobotOptions& robot : scene->robots)
    GLOAM_TRY_STATUS(finder.find_model(&robot.file, robot.loc));
  for (VisualOptions& visual : scene->visuals)
    GLOAM_TRY_STATUS(finder.find(&visual.file, visual.loc));
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
  if (scene->sky) GLOAM_TRY_STATUS(finder.find(&scene->sky->file, scene->sky->loc));
  for (VolumeOptions& volume : scene->volumes) {
    GLOAM_TRY_STATUS(finder.find(&volume.grid, volume.loc));
    GLOAM_TRY_STATUS(finder.find(&volume.temperature_grid, volume.loc));
  }
  return {};
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
  if (lower(path.extension().string()) != ".toml") {
    GLOAM_TRY_STATUS(check_model_file(absolute_path(path, ""), path.string(), {}));
    return as_bare_model();
  }
  Result<std::string> text = read_text_file(path, kLargestModel);
  if (!text.ok()) {
    Error error = std::move(text).error();
    std::error_code code;
    if (!fs::exists(path, code)) error.hint = suggest_file(absolute_path(path, ""));
    return error;
  }
  if (is_model_toml(*text)) return as_bare_model();
  if (text->size() > kLargestScene)
    return Error{
        ErrorKind::kInput, "a scene of more than 4 MiB is not read", {path.string(), 0, 0}};
  scene.file = path;
  GLOAM_TRY_STATUS(read_scene_toml(*text, path.string(), &scene));
  GLOAM_TRY(const ModelRoot root, find_model_root(path, access));
  GLOAM_TRY_STATUS(find_files(FileFinder(path, root, access), &scene));
  GLOAM_TRY_STATUS(validate_scene(scene));
  if (scene.robots.empty() && scene.environment.file.empty() && scene.visuals.empty()) {
    return Error{ErrorKind::kInput,
                 "the scene has nothing in it",
                 {path.string(), 0, 0},
                 "add at least one [[robot]], [[visual]] or an [environment]"};
  }
  return scene;
}

}  // namespace gloam

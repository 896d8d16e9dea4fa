#include <fmt/format.h>

#include <algorithm>

#include "base/files.h"
#include "base/text.h"
#include "gloam/scene.h"
#include "scene/model_path.h"
#include "scene/toml/toml_reader.h"
#include "scene/validate.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kLargestScene = uint64_t{4} << 20;

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
  const std::string extension = lower(path.extension().string());
  if (extension == ".toml") {
    return Error{ErrorKind::kInput, fmt::format("'{}' is a scene; a model is wanted here", name),
                 loc, "give an MJCF (.xml) or URDF file"};
  }
  if (extension == ".mjz" || extension == ".zip" || extension == ".mjb") {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("'{}' is an archive or binary model, which is not read", name), loc,
                 "give the MJCF (.xml) or URDF file"};
  }
  return {};
}

// Makes a path of the scene absolute and refuses it if it leaves the scene's root.
Status resolve(fs::path* file, const fs::path& scene_file, const ModelRoot& root,
               const FileAccess& access, const SourceLoc& loc) {
  const std::string written = file->string();
  const std::string refusal = why_not_a_path(written);
  if (!refusal.empty())
    return Error{ErrorKind::kInput, fmt::format("the file '{:.80}' {}", written, refusal), loc};
  const fs::path path = absolute_path(*file, absolute_path(scene_file, "").parent_path());
  std::vector<ModelRoot> roots{root};
  for (const auto& [name, folder] : access.packages) {
    std::error_code code;
    const fs::path canonical = fs::weakly_canonical(folder, code);
    roots.push_back({absolute_path(folder, ""), canonical, canonical});
  }
  const std::string why = why_not_readable(path, roots);
  if (!why.empty()) {
    return Error{ErrorKind::kInput, fmt::format("the file '{:.200}' {}", written, why), loc,
                 "--root FOLDER widens what the scene may read"};
  }
  GLOAM_TRY_STATUS(check_file(path, written, loc));
  *file = path;
  return {};
}

}  // namespace

Result<Scene> load_scene(const fs::path& path, const FileAccess& access) {
  Scene scene;
  scene.access = access;
  const std::string extension = lower(path.extension().string());
  if (extension != ".toml") {
    GLOAM_TRY_STATUS(check_file(absolute_path(path, ""), path.string(), {}));
    scene.name = path.stem().string();
    scene.bare_model = absolute_path(path, "");
    return scene;
  }
  Result<std::string> text = read_text_file(path, kLargestScene);
  if (!text.ok()) {
    Error error = std::move(text).error();
    std::error_code code;
    if (!fs::exists(path, code)) error.hint = suggest_file(absolute_path(path, ""));
    return error;
  }
  scene.file = path;
  scene.name = path.stem().string();
  GLOAM_TRY_STATUS(read_scene_toml(*text, path.string(), &scene));
  GLOAM_TRY(const ModelRoot root, find_model_root(path, access));
  if (!scene.environment.file.empty()) {
    GLOAM_TRY_STATUS(resolve(&scene.environment.file, path, root, access, scene.environment.loc));
  }
  for (RobotOptions& robot : scene.robots)
    GLOAM_TRY_STATUS(resolve(&robot.file, path, root, access, robot.loc));
  for (VisualOptions& visual : scene.visuals)
    GLOAM_TRY_STATUS(resolve(&visual.file, path, root, access, visual.loc));
  for (MaterialOptions& material : scene.materials) {
    if (material.bump.empty()) continue;
    GLOAM_TRY_STATUS(resolve(&material.bump, path, root, access, material.loc));
  }
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

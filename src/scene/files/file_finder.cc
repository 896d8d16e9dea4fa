#include "scene/files/file_finder.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/files.h"
#include "base/formats/foreign_format.h"
#include "base/plain_text.h"
#include "base/text.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

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

}  // namespace

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

Status check_model_file(const fs::path& path, const std::string& as_written, const SourceLoc& loc) {
  if (!is_container(path)) GLOAM_TRY_STATUS(refuse_foreign_format(path, loc));
  GLOAM_TRY_STATUS(check_file(path, as_written, loc));
  const std::string name = as_written.substr(0, 200);
  if (lower_extension(path) == ".toml") {
    GLOAM_TRY(const std::string text, read_plain_text(path, kLargestModelText));
    GLOAM_TRY(const toml::table table, parse_toml(text, path.string()));
    if (is_model_toml(table)) return {};
    return Error{ErrorKind::kInput,
                 fmt::format("'{}' is a scene, but a model is expected here", name), loc,
                 "use an MJCF (.xml) or URDF file, or a TOML model (docs/models.md)"};
  }
  constexpr uint64_t kLargestPointer = 1024;
  if (const Result<std::string> text = read_text_file(path, kLargestPointer);
      text.ok() && is_lfs_pointer(*text))
    return lfs_pointer_error(path.string());
  GLOAM_TRY_STATUS(refuse_mesh(path, name, loc));
  if (is_container(path)) {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("'{}' is an archive or binary model, which is not supported", name),
                 loc, "use the MJCF (.xml) or URDF file"};
  }
  return {};
}

bool is_model_toml(const toml::table& table) { return table.contains("mujoco"); }

Result<FileFinder> FileFinder::of_scene(const fs::path& scene_file, const FileAccess& access) {
  FileFinder finder;
  finder.folder_ = absolute_path(scene_file, "").parent_path();
  GLOAM_TRY(finder.roots_.emplace_back(), find_model_root(scene_file, access));
  std::error_code code;
  if (const fs::path own = catalogue_folder(); !own.empty()) {
    const fs::path canonical = fs::weakly_canonical(own, code);
    finder.roots_.push_back({own, canonical, canonical});
  }
  for (const auto& [name, folder] : access.packages) {
    const fs::path canonical = fs::weakly_canonical(folder, code);
    finder.roots_.push_back({absolute_path(folder, ""), canonical, canonical});
  }
  return finder;
}

Status FileFinder::find(fs::path* file, const SourceLoc& loc) const {
  if (file->empty()) return {};
  const std::string written = file->string();
  GLOAM_TRY_STATUS(resolve(file, written, loc));
  return check_file(*file, written, loc);
}

Status FileFinder::find_file_or_folder(fs::path* path, const SourceLoc& loc) const {
  if (path->empty()) return {};
  const std::string written = path->string();
  GLOAM_TRY_STATUS(resolve(path, written, loc));
  std::error_code code;
  if (fs::is_directory(*path, code)) return {};
  return check_file(*path, written, loc);
}

Status FileFinder::find_model(fs::path* file, const SourceLoc& loc) const {
  if (file->empty()) return {};
  const std::string written = file->string();
  GLOAM_TRY_STATUS(resolve(file, written, loc));
  return check_model_file(*file, written, loc);
}

Status FileFinder::resolve(fs::path* file, const std::string& written, const SourceLoc& loc) const {
  const std::string refusal = why_not_a_path(written);
  if (!refusal.empty())
    return Error{ErrorKind::kInput, fmt::format("the path '{:.80}' {}", written, refusal), loc};
  const fs::path path = absolute_path(*file, folder_);
  const std::string why = why_not_readable(path, roots_);
  if (!why.empty()) {
    return Error{ErrorKind::kInput, fmt::format("the file '{:.200}' {}", written, why), loc,
                 "use --root FOLDER to let the scene read from a larger folder"};
  }
  *file = path;
  return {};
}

}  // namespace gloam

#include "scene/files/model_path.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <pugixml.hpp>

#include "base/files.h"
#include "base/plain_text.h"
#include "geometry/mesh/model_file.h"
#include "gloam/program.h"
#include "scene/files/xml_text.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLevelsUp = 4;
constexpr size_t kLongestPath = 4000;  // below PATH_MAX
constexpr uint64_t kLargestPackageXml = uint64_t{1} << 20;

bool is_home_folder(const fs::path& folder) {
  if (folder == "/home" || folder == "/root" || folder == "/Users") return true;
  if (folder.parent_path() == "/home" || folder.parent_path() == "/Users") return true;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0) {
    std::error_code code;
    if (folder == fs::path(home).lexically_normal() || folder == fs::weakly_canonical(home, code))
      return true;
  }
  passwd entry{};
  passwd* found = nullptr;
  char buffer[4096];
  return getpwuid_r(getuid(), &entry, buffer, sizeof(buffer), &found) == 0 && found != nullptr &&
         found->pw_dir != nullptr && folder == fs::path(found->pw_dir);
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [in_folder, in_path] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return in_folder == folder.end() && in_path != path.end();
}

bool has_package_xml(const fs::path& folder) {
  std::error_code code;
  return fs::is_regular_file(folder / "package.xml", code);
}

bool may_read_below_wide(const fs::path& path, const fs::path& folder) {
  if (!is_below(path, folder)) return false;
  const fs::path below = path.lexically_relative(folder);
  if (folder == folder.root_path()) return !below.has_parent_path();
  return std::none_of(below.begin(), below.end(),
                      [](const fs::path& part) { return part.string().starts_with('.'); });
}

}  // namespace

bool is_container(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".mjz" || extension == ".zip" || extension == ".mjb";
}

Status refuse_mesh(const fs::path& path, const std::string& as_written, const SourceLoc& loc) {
  constexpr std::string_view kUnsupportedMeshes[] = {".msh", ".fbx"};
  if (!is_model_file(path) &&
      std::ranges::find(kUnsupportedMeshes, lower_extension(path)) == std::end(kUnsupportedMeshes))
    return {};
  return Error{ErrorKind::kInput,
               fmt::format("'{:.200}' is a mesh, but a model is expected here", as_written), loc,
               "add it as a [[visual]], as a body with [[object]] or as the [environment] file, or "
               "view it with gloam convert (docs/import.md)"};
}

bool holds_homes(const fs::path& folder) {
  if (folder == folder.root_path() || is_home_folder(folder)) return true;
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != 0 && is_below(fs::path(home).lexically_normal(), folder);
}

std::vector<fs::path> candidate_roots(const fs::path& file) {
  std::vector<fs::path> folders{file.parent_path()};
  std::error_code code;
  while (static_cast<int>(folders.size()) <= kMostLevelsUp) {
    const fs::path& below = folders.back();
    const fs::path folder = below.parent_path();
    if (fs::is_symlink(below, code) || folder == below || folder == folder.root_path() ||
        is_home_folder(below) || is_home_folder(folder))
      break;
    folders.push_back(folder);
  }
  return folders;
}

fs::path absolute_path(const fs::path& path, const fs::path& base) {
  std::error_code code;
  fs::path joined = path.is_absolute() ? path : base / path;
  if (!joined.is_absolute()) joined = fs::current_path(code) / joined;
  joined = joined.lexically_normal();
  return joined.has_filename() || joined == joined.root_path() ? joined : joined.parent_path();
}

std::string why_not_a_path(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestPath) return fmt::format("has {} characters", name.size());
  for (const char c : name) {
    if (static_cast<unsigned char>(c) < 0x20) return "contains a control character";
  }
  // "C:" and "http:" make a path absolute to MuJoCo, and mean something else to this system.
  const size_t colon = name.find(':');
  if (colon != std::string_view::npos && name.find_first_of("/\\") > colon)
    return "is a network address or has a scheme; only local files are supported";
  return {};
}

fs::path catalogue_folder() {
  const Result<fs::path> home = gloam_home();
  return home.ok() ? absolute_path(*home / "assets" / "robots", "") : fs::path();
}

Result<ModelRoot> find_model_root(const fs::path& file, const FileAccess& access) {
  const fs::path path = absolute_path(file, "");
  std::error_code code;
  fs::path root, linked;
  if (!access.root.empty()) {
    root = linked = absolute_path(access.root, "");
    const fs::path canonical_root = fs::weakly_canonical(root, code);
    const fs::path canonical = fs::weakly_canonical(path, code);
    if (!is_below(canonical, canonical_root)) {
      const fs::path own = catalogue_folder(), canonical_own = fs::weakly_canonical(own, code);
      if (!own.empty() && is_below(canonical, canonical_own))
        return ModelRoot{own, canonical_own, canonical_own};
      return Error{ErrorKind::kInput,
                   fmt::format("is not inside the folder '{}' given with --root", root.string()),
                   {path.string(), 0, 0},
                   "choose a --root that contains the file"};
    }
  } else if (access.strict) {
    root = linked = path.parent_path();
  } else {
    const std::vector<fs::path> folders = candidate_roots(path);
    const auto package = std::find_if(folders.begin(), folders.end(), has_package_xml);
    root = package != folders.end() ? *package : folders.back();
    linked = package != folders.end() ? *package : folders.front();
  }
  const bool is_wide = access.root.empty() && (root == root.root_path() || is_home_folder(root));
  return ModelRoot{root, fs::weakly_canonical(root, code), fs::weakly_canonical(linked, code),
                   is_wide};
}

std::string why_not_readable(const fs::path& path, const std::vector<ModelRoot>& roots) {
  std::error_code code;
  const fs::path canonical = fs::weakly_canonical(path, code);
  if (code) return fmt::format("cannot be accessed: {}", code.message());
  bool through_link = false;
  for (const ModelRoot& root : roots) {
    if (root.is_wide && !may_read_below_wide(canonical, root.canonical)) continue;
    if (is_below(canonical, root.linked)) return {};
    if (!is_below(canonical, root.canonical) && !is_below(path, root.folder)) continue;
    const fs::path expected =
        root.canonical / path.lexically_normal().lexically_relative(root.folder);
    if (expected.lexically_normal() == canonical) return {};
    through_link = true;
  }
  return through_link ? "is a symbolic link that leads out of the model's folder"
                      : "lies outside the folder that the model may read";
}

fs::path find_package(const std::string& name, const fs::path& file, const FileAccess& access) {
  for (const auto& [package, folder] : access.packages) {
    if (package == name) return absolute_path(folder, "");
  }
  const std::vector<fs::path> folders = candidate_roots(absolute_path(file, ""));
  for (const fs::path& folder : folders) {
    if (folder.filename() == name) return folder;
    if (!has_package_xml(folder)) continue;
    const Result<std::string> text = read_plain_text(folder / "package.xml", kLargestPackageXml);
    pugi::xml_document document;
    if (text.ok() && parse_xml(*text, "", pugi::parse_default, &document).ok() &&
        name == document.child("package").child_value("name"))
      return folder;
  }
  return {};
}

}  // namespace gloam

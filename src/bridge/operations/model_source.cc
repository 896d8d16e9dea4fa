#include "bridge/operations/model_source.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "bridge/operations/model_text.h"
#include "gloam/options.h"
#include "gloam/program.h"

namespace gloam::bridge {
namespace fs = std::filesystem;
namespace {

constexpr size_t kLongestModel = size_t{16} << 20;  // [bytes]
constexpr size_t kMostText = size_t{256} << 20;     // of all models that were texts [bytes]
constexpr size_t kLongestAddress = 4000;
constexpr const char* kRobotEntry = "robot.toml";  // docs/robots.md
constexpr std::string_view kFileScheme = "file://", kPackageScheme = "package://";
constexpr std::string_view kOwnScheme = "gloam://", kPropFolder = "gloam://prop/";

Error refuse(SpawnFailure* failure, SpawnFailure cause, std::string message,
             std::string hint = {}) {
  *failure = cause;
  return Error{ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

// "%20" as a blank; what is no such code stays.
std::string percent_decoded(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto is_hex = [&](size_t at) {
      return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at])) != 0;
    };
    if (text[i] == '%' && is_hex(i + 1) && is_hex(i + 2)) {
      out += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  std::error_code code;
  const fs::path whole = fs::weakly_canonical(path, code), top = fs::weakly_canonical(folder, code);
  if (code || top.empty()) return false;
  const auto [in_top, in_whole] = std::mismatch(top.begin(), top.end(), whole.begin(), whole.end());
  return in_top == top.end() || (std::next(in_top) == top.end() && in_top->empty());
}

fs::path folder_of(const Scene& scene) {
  std::error_code code;
  const fs::path file = scene.bare_model.empty() ? scene.file : scene.bare_model;
  if (file.empty()) return fs::current_path(code);
  return fs::absolute(file, code).parent_path();
}

/// Folders that come with Gloam.
std::vector<fs::path> own_folders() {
  const Result<fs::path> home = gloam_home();
  if (!home.ok()) return {};
  return {*home / "assets", *home / "examples"};
}

Result<fs::path> path_of(const std::string& uri, const Scene& scene) {
  const auto refused = [&](const char* why, const char* hint = "") {
    return Error{ErrorKind::kInput, fmt::format("'{:.200}' {}", uri, why), {}, hint};
  };
  if (uri.empty() || uri.size() > kLongestAddress) return refused("is not a file address");
  std::string path = percent_decoded(uri);
  if (std::ranges::any_of(path, [](unsigned char c) { return c < 0x20; }))
    return refused("contains a control character");
  if (path.starts_with(kFileScheme)) {
    path = path.substr(kFileScheme.size());
    if (path.starts_with("localhost/")) path = path.substr(9);
    if (!path.starts_with('/'))
      return refused("refers to another machine", "use file:///FOLDER/FILE");
    return fs::path(path);
  }
  if (path.starts_with(kOwnScheme)) {
    GLOAM_TRY(const fs::path home, gloam_home());
    return home / path.substr(kOwnScheme.size());
  }
  if (path.starts_with(kPackageScheme)) {
    path = path.substr(kPackageScheme.size());
    const size_t slash = std::min(path.find('/'), path.size());
    for (const auto& [name, folder] : scene.access.packages)
      if (name == path.substr(0, slash) && slash < path.size())
        return folder / path.substr(slash + 1);
    return refused("refers to an unknown package", "define it with --package NAME=FOLDER");
  }
  if (path.find("://") != std::string::npos) return refused("is not a supported address");
  return fs::path(path).is_absolute() ? fs::path(path) : folder_of(scene) / path;
}

// As the scene itself would name the file.
Status check_as_scene_would(const fs::path& file, const Scene& scene) {
  Scene only;
  only.file = scene.file.empty() && !scene.bare_model.empty() ? scene.bare_model : scene.file;
  only.access = scene.access;
  if (is_mesh_extension(lower_extension_of(file))) {
    only.objects.push_back({.name = "it", .file = file});
  } else if (file.filename() == kRobotEntry) {
    only.robots.push_back({.name = "it", .model = file.string()});
  } else {
    only.robots.push_back({.name = "it", .file = file});
  }
  const Result<Scene> read = overlay_scene(only, "", "client");
  return read.ok() ? Status() : Status(read.error());
}

}  // namespace

std::string lower_extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string prop_kind_of(const std::string& uri) {
  return uri.starts_with(kPropFolder) ? uri.substr(kPropFolder.size()) : std::string();
}

ModelSource::~ModelSource() {
  std::error_code code;
  if (!folder_.empty()) fs::remove_all(folder_, code);
}

bool ModelSource::is_own(const fs::path& file) const {
  const std::lock_guard lock(mutex_);
  return !folder_.empty() && is_below(file, folder_);
}

Result<fs::path> ModelSource::resolve(const std::string& uri, const Scene& scene) {
  GLOAM_TRY(const fs::path path, path_of(uri, scene));
  std::error_code code;
  if (!fs::is_regular_file(path, code))
    return Error{ErrorKind::kInput, fmt::format("there is no file '{:.200}'", uri)};
  for (const fs::path& folder : own_folders())
    if (is_below(path, folder)) return fs::weakly_canonical(path, code);
  GLOAM_TRY_STATUS(check_as_scene_would(path, scene));
  return path.lexically_normal();
}

Result<fs::path> ModelSource::resolve_folder(const std::string& uri, const Scene& scene) {
  GLOAM_TRY(const fs::path path, path_of(uri, scene));
  std::error_code code;
  if (!fs::exists(path, code))
    return Error{ErrorKind::kInput, fmt::format("there is no folder '{:.200}'", uri)};
  std::vector<fs::path> allowed = own_folders();
  allowed.push_back(scene.access.root.empty() ? folder_of(scene) : scene.access.root);
  for (const auto& [name, folder] : scene.access.packages) allowed.push_back(folder);
  for (const fs::path& folder : allowed)
    if (is_below(path, folder)) return path.lexically_normal();
  return Error{ErrorKind::kInput,
               fmt::format("'{:.200}' is outside of the folders that clients may read", uri),
               {},
               "start Gloam with --root FOLDER"};
}

Result<fs::path> ModelSource::write(const std::string& text, const std::string& extension) {
  const std::lock_guard lock(mutex_);
  if (written_ + text.size() > kMostText)
    return Error{ErrorKind::kUsage,
                 "the limit of 256 MiB for models sent as text has been reached"};
  written_ += text.size();
  std::error_code code;
  if (folder_.empty()) {
    std::string name = (fs::temp_directory_path(code) / "gloam_spawned_XXXXXX").string();
    if (code || ::mkdtemp(name.data()) == nullptr)
      return Error{ErrorKind::kIo,
                   "cannot create a folder for the client's model in the temporary folder"};
    folder_ = name;
  }
  const fs::path folder = folder_ / std::to_string(++count_);
  fs::create_directory(folder, code);
  // A package is the root of its models (docs/security.md).
  std::ofstream(folder / "package.xml") << "<package><name>spawned</name></package>\n";
  const fs::path file = folder / ("model" + extension);
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) return Error{ErrorKind::kIo, fmt::format("cannot write the file '{}'", file.string())};
  return file;
}

Result<SceneEntity> ModelSource::find(const SpawnRequest& request, const Scene& scene,
                                      const Pose& X_WE, std::string* model_name,
                                      SpawnFailure* failure) {
  if (request.uri.empty() && request.text.empty())
    return refuse(failure, SpawnFailure::kNoResource,
                  "the request contains neither an address nor a text");
  if (const std::string kind = prop_kind_of(request.uri); !kind.empty()) {
    const std::vector<PropInfo> known = prop_kinds();
    std::vector<std::string> kinds;
    for (const PropInfo& info : known) kinds.push_back(info.kind);
    if (std::ranges::find(kinds, kind) == kinds.end())
      return refuse(failure, SpawnFailure::kNoResource,
                    fmt::format("there is no prop '{:.100}'", kind), suggest_name(kind, kinds));
    return SceneEntity(PropOptions{.kind = kind, .position = X_WE.p, .orientation = X_WE.q});
  }
  RobotOptions robot{.X_WR = X_WE};
  std::string text = request.text;
  if (text.empty()) {
    const Result<fs::path> path = resolve(request.uri, scene);
    if (!path.ok()) {
      *failure = SpawnFailure::kNoResource;
      return path.error();
    }
    const std::string extension = lower_extension_of(*path);
    if (is_mesh_extension(extension))
      return SceneEntity(ObjectOptions{.file = *path, .X_WO = X_WE});
    if (!is_model_extension(extension))
      return refuse(failure, SpawnFailure::kUnsupportedFormat,
                    fmt::format("'{}' files are not supported", extension),
                    "use MJCF, URDF, glTF, OBJ, STL or PLY");
    if (path->filename() == kRobotEntry) {
      robot.model = path->string();
      *model_name = path->parent_path().filename().string();
      return SceneEntity(robot);
    }
    robot.file = *path;
    if (extension == ".toml") return SceneEntity(robot);
    std::ifstream in(*path, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  if (text.size() > kLongestModel)
    return refuse(failure, SpawnFailure::kUnsupportedFormat, "the model is larger than 16 MiB");
  const ModelText kind = model_text_of(text);
  if (kind == ModelText::kSdf || kind == ModelText::kUsd)
    return refuse(failure, SpawnFailure::kUnsupportedFormat, "SDF and USD are not supported",
                  "use MJCF or URDF");
  if (kind == ModelText::kOther)
    return refuse(failure, SpawnFailure::kParse, "the text is neither MJCF nor URDF");
  const bool is_urdf = kind == ModelText::kUrdf;
  *model_name = attribute_of(text, is_urdf ? "robot" : "mujoco", is_urdf ? "name" : "model");
  if (is_urdf && !is_fixed_urdf(text)) robot.base = "free";
  if (!robot.file.empty()) return SceneEntity(robot);
  if (!scene.access.root.empty())
    return refuse(failure, SpawnFailure::kOther,
                  "models cannot be sent as text when --root restricts file access");
  *failure = SpawnFailure::kOther;
  GLOAM_TRY(robot.file, write(text, is_urdf ? ".urdf" : ".xml"));
  return SceneEntity(robot);
}

}  // namespace gloam::bridge

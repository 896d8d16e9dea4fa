#include "bridge/foxglove/assets.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "bridge/operations/model_source.h"
#include "gloam/scene.h"

namespace gloam::bridge::foxglove {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kLargestAsset = uintmax_t{64} << 20;        // [bytes]
constexpr uintmax_t kLargestDescription = uintmax_t{64} << 20;  // [bytes]
constexpr std::array<std::string_view, 6> kMeshExtensions = {".stl", ".obj",  ".dae",
                                                             ".glb", ".gltf", ".ply"};
constexpr int kPackageLevels = 5;  // folders above a model in which its packages are looked for

Result<std::vector<uint8_t>> read_whole(const fs::path& file, uintmax_t most) {
  std::error_code error;
  const auto size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  if (error || size == 0 || size > most)
    return Error{ErrorKind::kIo, "'" + file.filename().string() + "' is missing or too large"};
  std::vector<uint8_t> bytes(size);
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    return Error{ErrorKind::kIo, "cannot read '" + file.filename().string() + "'"};
  return bytes;
}

/// Folder that package://NAME/ stands for in a model; empty = none is found.
fs::path package_folder(const std::string& name, const fs::path& model, const FileAccess& access) {
  for (const auto& [package, folder] : access.packages)
    if (package == name) return folder;
  fs::path folder = model.parent_path();
  for (int level = 0; level < kPackageLevels && folder.has_filename(); ++level) {
    std::error_code ignored;
    if (folder.filename() == name) return folder;
    if (fs::is_directory(folder / name, ignored)) return folder / name;
    folder = folder.parent_path();
  }
  return {};
}

/// The mesh that a package://NAME/… of a model stands for; empty = none that may be given away.
fs::path find_mesh(const std::string& uri, const fs::path& model, const FileAccess& access) {
  constexpr std::string_view kScheme = "package://";
  if (!uri.starts_with(kScheme)) return {};
  const std::string rest = uri.substr(kScheme.size());
  const size_t slash = rest.find('/');
  if (slash == 0 || slash == std::string::npos) return {};
  std::error_code error;
  const fs::path folder =
      fs::canonical(package_folder(rest.substr(0, slash), model, access), error);
  if (error) return {};
  const fs::path file = fs::canonical(folder / rest.substr(slash + 1), error);
  if (error) return {};
  // A link or ".." may not lead out of the package, and secrets are no meshes.
  const bool is_inside =
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
  const bool is_mesh = std::ranges::count(kMeshExtensions, lower_extension_of(file)) > 0;
  return is_inside && is_mesh ? file : fs::path();
}

}  // namespace

std::vector<std::string> mesh_names(std::string_view urdf) {
  constexpr std::string_view kElement = "<mesh", kAttribute = "filename=";
  std::vector<std::string> names;
  for (size_t at = urdf.find(kElement); at != std::string_view::npos;
       at = urdf.find(kElement, at + 1)) {
    const std::string_view element = urdf.substr(at, urdf.find('>', at) - at);
    const size_t value = element.find(kAttribute);
    if (value == std::string_view::npos) continue;
    const std::string_view quoted = element.substr(value + kAttribute.size());
    if (quoted.empty() || (quoted[0] != '"' && quoted[0] != '\'')) continue;
    std::string name(quoted.substr(1, quoted.find(quoted[0], 1) - 1));
    if (std::ranges::count(names, name) == 0) names.push_back(std::move(name));
  }
  return names;
}

void Assets::follow() {
  const World world = simulation_.world();
  if (world.compiled() == world_) return;
  world_ = world.compiled();
  files_.clear();
  std::vector<fs::path> models = {world.scene().bare_model};
  for (const RobotOptions& robot : world.scene().robots) models.push_back(robot.file);
  for (const fs::path& model : models) {
    const auto text = read_whole(model, kLargestDescription);
    if (!text.ok()) continue;
    const std::string_view urdf(reinterpret_cast<const char*>(text->data()), text->size());
    for (const std::string& uri : mesh_names(urdf))
      if (const fs::path file = find_mesh(uri, model, world.scene().access); !file.empty())
        files_[uri] = file;
  }
}

Result<std::shared_ptr<const std::vector<uint8_t>>> Assets::fetch(const std::string& uri) {
  follow();
  const auto found = files_.find(uri);
  if (found == files_.end())
    return Error{ErrorKind::kInput, "no robot description refers to '" + uri + "'"};
  GLOAM_TRY(auto bytes, read_whole(found->second, kLargestAsset));
  return std::make_shared<const std::vector<uint8_t>>(std::move(bytes));
}

}  // namespace gloam::bridge::foxglove

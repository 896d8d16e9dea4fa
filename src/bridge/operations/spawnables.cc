// Operator: models that clients may spawn.

#include <algorithm>
#include <filesystem>

#include "bridge/operations/model_text.h"
#include "bridge/operations/operator_private.h"
#include "gloam/program.h"

namespace gloam::bridge {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostListed = 2000;
constexpr int kMaxFolderDepth = 4;

void list_models(const fs::path& folder, std::vector<Spawnable>* list) {
  std::error_code code;
  std::vector<fs::path> files;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator it(folder, options, code), end; !code && it != end;
       it.increment(code)) {
    if (it.depth() > kMaxFolderDepth) it.disable_recursion_pending();
    std::string extension = it->path().extension().string();
    if (!it->is_regular_file(code) || it->path().filename() == "package.xml") continue;
    if (is_model_extension(extension) || is_mesh_extension(extension)) files.push_back(it->path());
    if (files.size() >= kMostListed) break;
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const bool is_mesh = is_mesh_extension(file.extension().string());
    const bool is_robot = file.filename() == "robot.toml";
    list->push_back({"file://" + file.string(),
                     is_mesh    ? "mesh, spawned as a body"
                     : is_robot ? "robot with controller"
                                : "model",
                     {}});
  }
}

}  // namespace

Result<std::vector<Spawnable>> Operator::spawnables(const std::vector<std::string>& folders) const {
  std::vector<Spawnable> list;
  for (const PropInfo& prop : prop_kinds())
    list.push_back({"gloam://prop/" + prop.kind, prop.text, prop.size});
  if (const Result<fs::path> home = gloam_home(); home.ok())
    list_models(*home / "assets/robots", &list);
  const Scene scene = written_scene(simulation_.world());
  for (const std::string& folder : folders) {
    GLOAM_TRY(const fs::path path, ModelSource::resolve_folder(folder, scene));
    list_models(path, &list);
  }
  return list;
}

}  // namespace gloam::bridge

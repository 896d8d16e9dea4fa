#include "runtime/log/files/run_files.h"

#include <set>

#include "geometry/mesh/model_file.h"
#include "scene/files/model_path.h"
#include "scene/toml/scene_paths.h"
#include "world/compile/model_loader.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

class FileList {
 public:
  explicit FileList(const Scene& scene) : scene_(scene) {}

  void add(const fs::path& named) {
    const fs::path path = absolute_path(named, scene_.file.parent_path());
    std::error_code code;
    if (!fs::is_regular_file(path, code) || !known_.insert(path).second) return;
    files_.push_back(path);
    for (const fs::path& folder : candidate_roots(path)) add_package(folder);
  }

  /// Adds a file and, of a mesh or glTF, the pictures and libraries beside it that it names.
  void add_with_parts(const fs::path& named) {
    add(named);
    if (!is_model_file(named)) return;
    const auto model = load_model_file(scene_, absolute_path(named, scene_.file.parent_path()),
                                       named.filename().string(), {});
    if (!model.ok()) return;  // the renderer reports it
    for (const std::string& part : model->parts) add(named.parent_path() / part);
  }

  std::vector<fs::path> take() { return std::move(files_); }

 private:
  void add_package(const fs::path& folder) {
    if (!folders_.insert(folder).second) return;
    std::error_code code;
    const fs::path package = folder / "package.xml";
    if (fs::is_regular_file(package, code) && known_.insert(package).second)
      files_.push_back(package);
  }

  const Scene& scene_;
  std::vector<fs::path> files_;
  std::set<fs::path> known_, folders_;
};

}  // namespace

std::vector<fs::path> run_files(const CompiledWorld& world) {
  FileList list(world.written);
  if (!world.written.bare_model.empty()) list.add(world.written.bare_model);
  for (const Dependency& file : world.files)
    if (file.exists) list.add(file.path);
  // Only `scene` has the values drawn by [[randomize]], only `written` has the omitted elements.
  for (const Scene* scene : {&world.written, &world.scene}) {
    Scene copy = *scene;
    // A log contains the controls that networks gave, and is replayed without them.
    for (RobotOptions& robot : copy.robots)
      robot.controller.network = robot.controller.settings = fs::path();
    visit_scene_paths(&copy, [&list](fs::path* path) { list.add_with_parts(*path); });
  }
  for (const VisualOnlyMesh& mesh : world.visual_meshes) list.add_with_parts(mesh.file);
  return list.take();
}

}  // namespace gloam

// Operator: scenes that clients load and unload.

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "bridge/operations/operator_private.h"
#include "gloam/program.h"

namespace gloam::bridge {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostScenes = 1000;

// Remark at the top of a scene file.
std::string first_remark(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  if (!line.starts_with("# ")) return {};
  return line.substr(2, 200);
}

bool is_scene_file(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  for (int i = 0; i < 200 && std::getline(in, line); ++i) {
    if (line.starts_with("[mujoco")) return false;
    if (line.starts_with("[environment") || line.starts_with("[[robot") ||
        line.starts_with("[scene") || line.starts_with("[sim"))
      return true;
  }
  return false;
}

std::string address_of(const fs::path& file) {
  std::error_code code;
  return "file://" + fs::absolute(file, code).lexically_normal().string();
}

void list_scenes(const fs::path& folder, std::vector<WorldFile>* list) {
  std::error_code code;
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code))
    if (it->path().extension() == ".toml" && it->is_regular_file(code) &&
        files.size() < kMostScenes)
      files.push_back(it->path());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const std::string uri = address_of(file);
    if (!is_scene_file(file) || std::ranges::find(*list, uri, &WorldFile::uri) != list->end())
      continue;
    list->push_back({file.stem().string(), uri, first_remark(file)});
  }
}

WorldFile describe_world(const Scene& scene) {
  const fs::path file = scene.bare_model.empty() ? scene.file : scene.bare_model;
  std::error_code code;
  if (file.empty() || !fs::exists(file, code)) return {scene.name, "", "created by a client"};
  return {scene.name, address_of(file), scene.bare_model.empty() ? first_remark(file) : "model"};
}

}  // namespace

Result<std::vector<WorldFile>> Operator::worlds(const std::vector<std::string>& folders) const {
  std::vector<WorldFile> list;
  if (const Result<fs::path> home = gloam_home(); home.ok()) list_scenes(*home / "examples", &list);
  const Scene scene = private_->first_scene();
  std::error_code code;
  if (!scene.file.empty()) list_scenes(fs::absolute(scene.file, code).parent_path(), &list);
  for (const std::string& folder : folders) {
    GLOAM_TRY(const fs::path path, ModelSource::resolve_folder(folder, scene));
    list_scenes(path, &list);
  }
  return list;
}

Result<WorldFile> Operator::current_world() const {
  GLOAM_TRY_STATUS(private_->need_world());
  return describe_world(written_scene(simulation_.world()));
}

Result<Scene> Operator::Private::read_world(const std::string& uri, const std::string& text,
                                            const std::vector<WorldFile>& known) const {
  const Scene from = first_scene();
  if (!text.empty()) {
    std::error_code code;
    const fs::path folder =
        from.file.empty() ? fs::current_path(code) : fs::absolute(from.file, code).parent_path();
    return parse_scene(text, folder, from.access);
  }
  const auto named = std::ranges::find(known, uri, &WorldFile::name);
  const std::string address = named != known.end() ? named->uri : uri;
  const size_t slash = address.rfind('/');
  if (address.empty())
    return Error{ErrorKind::kInput, "the request contains neither an address nor a text"};
  if (slash == std::string::npos && !address.ends_with(".toml")) {
    std::vector<std::string> names;
    for (const WorldFile& file : known) names.push_back(file.name);
    return Error{ErrorKind::kInput,
                 fmt::format("there is no world '{:.200}'", address),
                 {},
                 suggest_name(address, names)};
  }
  const std::string parent = slash == std::string::npos ? "." : address.substr(0, slash);
  GLOAM_TRY(const fs::path folder, ModelSource::resolve_folder(parent, from));
  return load_scene(folder / address.substr(slash == std::string::npos ? 0 : slash + 1),
                    from.access);
}

Scene Operator::Private::first_scene() const {
  const std::lock_guard lock(names_mutex);
  return first;
}

Status Operator::Private::enter(const Scene& scene) {
  const double timestep = 1 / simulation.step_rate().value();
  GLOAM_TRY(World world, World::compile(scene));
  if (std::abs(world.info().timestep - timestep) > 1e-12) {
    Scene other = scene;  // a simulation keeps its timestep
    other.sim.timestep = timestep;
    GLOAM_TRY(world, World::compile(other));
  }
  simulation.pause();
  GLOAM_TRY_STATUS(simulation.recompile(world));
  return simulation.post({.what = ResetSim{}});
}

Result<WorldFile> Operator::load_world(const std::string& uri, const std::string& text) {
  Private& p = *private_;
  GLOAM_TRY(const std::vector<WorldFile> known, worlds());
  GLOAM_TRY(const Scene read, p.read_world(uri, text, known));
  const Scene scene = p.without_access(read);
  p.stop_stepping = true;
  const std::lock_guard one_at_a_time(p.change_mutex);
  p.loading = true;
  const Status status = p.enter(scene);
  p.loading = false;
  GLOAM_TRY_STATUS(status);
  p.unloaded = false;
  p.rests = true;
  const std::lock_guard lock(p.names_mutex);
  p.first = scene;
  p.spawned.clear();
  p.infos.clear();
  p.waiting.clear();
  return describe_world(scene);
}

Status Operator::unload_world() {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  p.stop_stepping = true;
  const std::lock_guard one_at_a_time(p.change_mutex);
  Scene empty;
  {
    const Scene first = p.first_scene();
    empty.file = first.file;
    empty.access = first.access;
  }
  GLOAM_TRY_STATUS(p.enter(empty));
  p.unloaded = true;
  return {};
}

}  // namespace gloam::bridge

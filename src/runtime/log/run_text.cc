#include "runtime/log/run_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/hash.h"
#include "base/nesting.h"
#include "gloam/options.h"
#include "gloam/program.h"
#include "runtime/log/files/portable_paths.h"
#include "runtime/log/files/run_files.h"
#include "scene/files/model_path.h"
#include "scene/toml/scene_paths.h"
#include "sim/state/model_hash.h"
#include "world/version.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

uint64_t hash_file(const fs::path& path) {
  const auto bytes = read_file(path);
  return bytes.ok() ? hash_bytes(bytes->data(), bytes->size()) : 0;
}

uint64_t from_hex(const std::string& text) { return std::stoull(text, nullptr, 16); }

}  // namespace

DescribedRun describe_run(const CompiledWorld& world, uint64_t seed, std::optional<double> timestep,
                          const fs::path& log) {
  const Scene& scene = world.written;
  DescribedRun run;
  run.files = run_files(world);
  RunText& text = run.text;
  text.version = version();
  text.mujoco = mujoco_version();
  text.configuration = configuration();
  text.seed = seed;
  text.timestep = timestep.value_or(0);
  text.name = scene.name;
  const fs::path file = scene.bare_model.empty() ? scene.file : scene.bare_model;
  run.folder = file.empty() ? common_folder(run.files) : absolute_path(file, "").parent_path();
  text.folder = portable_relative(run.folder, absolute_path(log, "").parent_path()).string();
  if (scene.bare_model.empty())
    text.file = file.filename().string();
  else
    text.bare_model = file.filename().string();
  text.keyframe = world.keyframe;
  std::vector<fs::path> package_folders;
  for (const auto& [name, folder] : scene.access.packages)
    package_folders.push_back(absolute_path(folder, ""));
  const PortablePaths paths(run.folder, run.files, package_folders);
  Scene portable = scene;
  visit_scene_paths(&portable, [&](fs::path* path) {
    *path = paths.name(absolute_path(*path, scene.file.parent_path()));
  });
  portable.file.clear();
  text.toml = to_toml(portable);
  text.has_root = !scene.access.root.empty();
  for (size_t i = 0; i < package_folders.size(); ++i)
    text.packages.push_back({scene.access.packages[i].first, paths.name(package_folders[i])});
  text.model_hash = hash_model(*world.model);
  for (const fs::path& path : run.files) text.files.push_back({paths.name(path), hash_file(path)});
  return run;
}

std::string to_json(const RunText& text) {
  Json files = Json::array();
  for (const RunText::File& file : text.files)
    files.push_back({{"path", file.path}, {"hash", hash_to_hex(file.hash)}});
  Json packages = Json::array();
  for (const RunText::Package& package : text.packages)
    packages.push_back({{"name", package.name}, {"folder", package.folder}});
  const Json json = {{"format", text.format},     {"run", text.run},
                     {"step", text.step},         {"gloam", text.version},
                     {"mujoco", text.mujoco},     {"configuration", text.configuration},
                     {"seed", text.seed},         {"timestep", text.timestep},
                     {"name", text.name},         {"folder", text.folder},
                     {"file", text.file},         {"bare_model", text.bare_model},
                     {"keyframe", text.keyframe}, {"model_hash", hash_to_hex(text.model_hash)},
                     {"files", std::move(files)}, {"packages", std::move(packages)},
                     {"has_root", text.has_root}, {"history", text.has_history},
                     {"scene", text.toml}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<RunText> parse_run_text(std::string_view json_text) {
  GLOAM_TRY_STATUS(check_excess(json_excess(json_text), json_text, "the log's run"));
  try {
    const Json json = Json::parse(json_text);
    RunText text;
    text.format = json.value("format", 1);
    json.at("run").get_to(text.run);
    json.at("step").get_to(text.step);
    json.at("gloam").get_to(text.version);
    json.at("mujoco").get_to(text.mujoco);
    json.at("configuration").get_to(text.configuration);
    json.at("seed").get_to(text.seed);
    json.at("timestep").get_to(text.timestep);
    json.at("name").get_to(text.name);
    json.at("folder").get_to(text.folder);
    text.file = json.value("file", "");
    json.at("bare_model").get_to(text.bare_model);
    json.at("keyframe").get_to(text.keyframe);
    json.at("scene").get_to(text.toml);
    text.has_history = json.value("history", false);
    text.model_hash = from_hex(json.at("model_hash").get<std::string>());
    for (const Json& file : json.at("files"))
      text.files.push_back(
          {file.at("path").get<std::string>(), from_hex(file.at("hash").get<std::string>())});
    text.has_root = json.value("has_root", false);
    for (const Json& package : json.value("packages", Json::array()))
      text.packages.push_back(
          {package.at("name").get<std::string>(), package.at("folder").get<std::string>()});
    const bool is_timestep = text.timestep == 0 || (text.timestep >= 1e-9 && text.timestep < 1e3);
    if (text.run < 0 || text.step < 0 || !is_timestep)
      return Error{
          ErrorKind::kInput,
          fmt::format("the log's run description is damaged: run {}, step {}, timestep {:g} s",
                      text.run, text.step, text.timestep)};
    return text;
  } catch (const std::exception& error) {
    return Error{ErrorKind::kInput,
                 fmt::format("the log's run description: {:.200}", error.what())};
  }
}

fs::path path_in(const fs::path& folder, const RunText::File& file) {
  return (folder / file.path).lexically_normal();  // format 1 may have absolute paths
}

bool is_in_place(const fs::path& folder, const RunText::File& file) {
  const auto bytes = read_file(path_in(folder, file));
  return bytes.ok() && hash_bytes(bytes->data(), bytes->size()) == file.hash;
}

namespace {

std::string changed_files(const RunText& text, const fs::path& folder) {
  std::string changed;
  for (const RunText::File& file : text.files)
    if (!is_in_place(folder, file))
      changed += (changed.empty() ? "" : ", ") + path_in(folder, file).string();
  return changed.empty() ? changed
                         : "files of the scene have changed since the log was written: " + changed;
}

// The hash of format 1: of the whole model, its absolute paths included.
uint64_t hash_saved_model(const mjModel& model) {
  std::vector<std::byte> bytes(static_cast<size_t>(mj_sizeModel(&model)));
  mj_saveModel(&model, nullptr, bytes.data(), static_cast<int>(bytes.size()));
  return hash_bytes(bytes.data(), bytes.size());
}

bool is_same_model(const RunText& text, const mjModel& model) {
  return text.model_hash == (text.format < 2 ? hash_saved_model(model) : hash_model(model));
}

}  // namespace

Result<Scene> scene_of(const RunText& text, const SceneFolder& folder) {
  // A stranger's log could lead out of the folder.
  for (const fs::path file : {text.file, text.bare_model})
    if (file != file.filename() || file == "..")
      return Error{ErrorKind::kInput,
                   fmt::format("the log's run refers to '{:.80}', which is not a plain file name",
                               file.string())};
  Scene scene;
  if (text.bare_model.empty()) {
    GLOAM_TRY(scene, parse_scene(text.toml, folder.path, folder.access));
    if (!text.file.empty()) scene.file = folder.path / text.file;
  } else {
    GLOAM_TRY(scene, load_scene(folder.path / text.bare_model, folder.access));
  }
  scene.name = text.name;
  return scene;
}

Result<std::shared_ptr<const CompiledWorld>> compile_run(const RunText& text,
                                                         const SceneFolder& folder) {
  GLOAM_TRY(const Scene scene, scene_of(text, folder));
  Result<World> world =
      text.keyframe.empty() ? World::compile(scene) : World::compile_at(scene, text.keyframe);
  if (!world.ok()) {
    Error error = world.error();
    const std::string changed = changed_files(text, folder.path);
    if (!changed.empty()) error.hint = changed;
    return error;
  }
  return world->compiled();
}

Status check_same_bits(const RunText& text, const CompiledWorld& world, const SceneFolder& folder) {
  const bool is_same_program = text.version == version() && text.mujoco == mujoco_version() &&
                               text.configuration == configuration();
  if (is_same_program && is_same_model(text, *world.model)) return {};
  const std::string changed = changed_files(text, folder.path);
  if (!changed.empty())
    return Error{ErrorKind::kInput, changed, {}, "restore the files that it was recorded with"};
  return Error{ErrorKind::kInput,
               fmt::format("the log was written by another version or on another machine (Gloam "
                           "{}, MuJoCo {}, {}; this is Gloam {}, MuJoCo {}, {})",
                           text.version, text.mujoco, text.configuration, version(),
                           mujoco_version(), configuration()),
               {},
               "verify it with the version that wrote it; a replay uses its logged poses"};
}

}  // namespace gloam

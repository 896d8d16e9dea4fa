#include "runtime/log/run_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/hash.h"
#include "base/nesting.h"
#include "gloam/options.h"
#include "gloam/program.h"
#include "world/version.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

std::string near(const fs::path& path, const fs::path& folder) {
  const fs::path relative = folder.empty() ? fs::path() : path.lexically_relative(folder);
  return (relative.empty() ? path : relative).string();
}

uint64_t hash_file(const fs::path& path) {
  const auto bytes = read_file(path);
  return bytes.ok() ? hash_bytes(bytes->data(), bytes->size()) : 0;
}

uint64_t from_hex(const std::string& text) { return std::stoull(text, nullptr, 16); }

}  // namespace

uint64_t hash_model(const mjModel& model) {
  std::vector<std::byte> bytes(static_cast<size_t>(mj_sizeModel(&model)));
  mj_saveModel(&model, nullptr, bytes.data(), static_cast<int>(bytes.size()));
  return hash_bytes(bytes.data(), bytes.size());
}

RunText describe_run(const CompiledWorld& world, uint64_t seed, std::optional<double> timestep) {
  const Scene& scene = world.written;
  RunText text;
  text.version = version();
  text.mujoco = mujoco_version();
  text.configuration = configuration();
  text.seed = seed;
  text.timestep = timestep.value_or(0);
  text.name = scene.name;
  const fs::path file = scene.bare_model.empty() ? scene.file : scene.bare_model;
  const fs::path folder = file.empty() ? fs::path() : fs::absolute(file).parent_path();
  text.folder = folder.string();
  text.file = scene.bare_model.empty() ? file.filename().string() : std::string();
  if (!scene.bare_model.empty()) text.bare_model = near(fs::absolute(scene.bare_model), folder);
  text.keyframe = world.keyframe;
  text.toml = to_toml(scene);
  text.model_hash = hash_model(*world.model);
  for (const Dependency& dependency : world.files)
    if (dependency.exists)
      text.files.push_back({near(dependency.path, folder), hash_file(dependency.path)});
  return text;
}

std::string to_json(const RunText& text) {
  Json files = Json::array();
  for (const RunText::File& file : text.files)
    files.push_back({{"path", file.path}, {"hash", hash_to_hex(file.hash)}});
  const Json json = {{"run", text.run},
                     {"step", text.step},
                     {"gloam", text.version},
                     {"mujoco", text.mujoco},
                     {"configuration", text.configuration},
                     {"seed", text.seed},
                     {"timestep", text.timestep},
                     {"name", text.name},
                     {"folder", text.folder},
                     {"file", text.file},
                     {"bare_model", text.bare_model},
                     {"keyframe", text.keyframe},
                     {"model_hash", hash_to_hex(text.model_hash)},
                     {"files", std::move(files)},
                     {"history", text.has_history},
                     {"scene", text.toml}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<RunText> parse_run_text(std::string_view json_text) {
  GLOAM_TRY_STATUS(check_excess(json_excess(json_text), json_text, "the log's run"));
  try {
    const Json json = Json::parse(json_text);
    RunText text;
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
    return text;
  } catch (const std::exception& error) {
    return Error{ErrorKind::kInput,
                 fmt::format("the log's description of its run: {:.200}", error.what())};
  }
}

namespace {

std::string changed_files(const RunText& text, const fs::path& folder) {
  std::string changed;
  for (const RunText::File& file : text.files) {
    const fs::path path =
        fs::path(file.path).is_absolute() ? fs::path(file.path) : folder / file.path;
    if (hash_file(path) != file.hash) changed += (changed.empty() ? "" : ", ") + path.string();
  }
  return changed.empty() ? changed
                         : "files of the scene have changed since the log was written: " + changed;
}

}  // namespace

fs::path folder_of(const RunText& text, const fs::path& folder) {
  return folder.empty() ? fs::path(text.folder) : folder;
}

Result<Scene> scene_of(const RunText& text, const fs::path& folder) {
  const fs::path from = folder_of(text, folder);
  // A stranger's log could lead out of the folder.
  for (const fs::path file : {text.file, text.bare_model})
    if (file != file.filename() || file == "..")
      return Error{ErrorKind::kInput, fmt::format("the log's run is of '{:.80}', which is no file "
                                                  "of a folder",
                                                  file.string())};
  Scene scene;
  if (text.bare_model.empty()) {
    GLOAM_TRY(scene, parse_scene(text.toml, from));
    if (!text.file.empty()) scene.file = from / text.file;
  } else {
    GLOAM_TRY(scene, load_scene(from / text.bare_model));
  }
  scene.name = text.name;
  return scene;
}

Result<std::shared_ptr<const CompiledWorld>> compile_run(const RunText& text,
                                                         const fs::path& folder) {
  GLOAM_TRY(const Scene scene, scene_of(text, folder));
  Result<World> world =
      text.keyframe.empty() ? World::compile(scene) : World::compile_at(scene, text.keyframe);
  if (!world.ok()) {
    Error error = world.error();
    const std::string changed = changed_files(text, folder_of(text, folder));
    if (!changed.empty()) error.hint = changed;
    return error;
  }
  return world->compiled();
}

Status check_same_bits(const RunText& text, const CompiledWorld& world, const fs::path& folder) {
  const bool is_same_program = text.version == version() && text.mujoco == mujoco_version() &&
                               text.configuration == configuration();
  if (is_same_program && hash_model(*world.model) == text.model_hash) return {};
  const std::string changed = changed_files(text, folder_of(text, folder));
  if (!changed.empty())
    return Error{ErrorKind::kInput, changed, {}, "bring back the files that it was written with"};
  return Error{ErrorKind::kInput,
               fmt::format("the log was written by another program or machine (Gloam {}, MuJoCo "
                           "{}, {}; this is Gloam {}, MuJoCo {}, {})",
                           text.version, text.mujoco, text.configuration, version(),
                           mujoco_version(), configuration()),
               {},
               "step it again with the version that wrote it; a replay shows its poses"};
}

}  // namespace gloam

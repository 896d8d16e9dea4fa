// Operator: entities that clients add and remove.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "bridge/operations/operator_private.h"
#include "bridge/operations/pose_math.h"
#include "gloam/program.h"
#include "gloam/topics.h"

namespace gloam::bridge {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostSpawned = 1000, kLongestName = 128;
constexpr int kMostListed = 2000, kDeepest = 4;

SpawnResult failed(SpawnFailure failure, Error error) {
  return {.failure = failure, .error = std::move(error)};
}
SpawnResult failed(SpawnFailure failure, std::string message, std::string hint = {}) {
  return failed(failure, Error{ErrorKind::kInput, std::move(message), {}, std::move(hint)});
}

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
  });
}

// A name of ROS: tokens that do not begin with a digit, between slashes.
bool is_namespace(std::string_view ns) {
  if (ns.size() > kLongestName) return false;
  if (ns.starts_with('/')) ns.remove_prefix(1);
  bool at_start = true;
  for (const char c : ns) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (c == '/') {
      if (at_start) return false;
    } else if (!(std::isalpha(static_cast<unsigned char>(c)) || c == '_' || (digit && !at_start))) {
      return false;
    }
    at_start = c == '/';
  }
  return !at_start;
}

// Name of a resource: that of the model itself, else of its file.
std::string default_name(const SceneEntity& entity, const std::string& model_name,
                         const ModelSource& source) {
  if (const auto* prop = std::get_if<PropOptions>(&entity)) return prop->kind;
  const auto* object = std::get_if<ObjectOptions>(&entity);
  const fs::path file = object != nullptr ? object->file : std::get<RobotOptions>(entity).file;
  std::string name = !model_name.empty() || source.is_own(file) ? model_name : file.stem().string();
  std::erase_if(name, [](char c) { return !is_name(std::string_view(&c, 1)); });
  return name.substr(0, kLongestName);
}

void add_to_scene(SceneEntity entity, const std::string& name, Scene* scene) {
  std::visit([&](auto& options) { options.name = name; }, entity);
  if (auto* robot = std::get_if<RobotOptions>(&entity)) scene->robots.push_back(std::move(*robot));
  if (auto* object = std::get_if<ObjectOptions>(&entity))
    scene->objects.push_back(std::move(*object));
  if (auto* prop = std::get_if<PropOptions>(&entity)) scene->props.push_back(std::move(*prop));
}

// Cause of a compile's failure, by what its message says: MuJoCo and Gloam tell of files alike.
SpawnFailure cause_of(const Error& error) {
  if (error.kind == ErrorKind::kUsage) return SpawnFailure::kOther;
  for (const char* words :
       {"there is no file", "does not exist", "outside the folder", "could not open",
        "cannot be read", "cannot open", "resource not found", "not found"})
    if (error.message.find(words) != std::string::npos) return SpawnFailure::kMissingAssets;
  return SpawnFailure::kParse;
}

/// Gives a robot's topics another beginning: "/NAME/odom" → "/ns/odom".
Status rename_topics(const World& world, const std::string& name, const std::string& ns,
                     Scene* scene) {
  GLOAM_TRY(const std::vector<TopicInfo> topics, list_topics(world));
  std::string token = name;
  std::ranges::replace_if(token, [](unsigned char c) { return !std::isalnum(c); }, '_');
  const std::string begin = "/" + token + "/", other = ns.starts_with('/') ? ns : "/" + ns;
  for (const TopicInfo& topic : topics)
    if (topic.name.starts_with(begin))
      scene->topics.push_back(
          {.name = topic.name, .rename = other + topic.name.substr(begin.size() - 1)});
  return {};
}

template <class Options>
bool erase_named(std::string_view name, std::vector<Options>* all) {
  return std::erase_if(*all, [&](const Options& o) { return o.name == name; }) > 0;
}

void list_models(const fs::path& folder, std::vector<Spawnable>* list) {
  std::error_code code;
  std::vector<fs::path> files;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator it(folder, options, code), end; !code && it != end;
       it.increment(code)) {
    if (it.depth() > kDeepest) it.disable_recursion_pending();
    std::string extension = it->path().extension().string();
    if (!it->is_regular_file(code) || it->path().filename() == "package.xml") continue;
    if (is_model_extension(extension) || is_mesh_extension(extension)) files.push_back(it->path());
    if (files.size() >= kMostListed) break;
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    const bool is_mesh = is_mesh_extension(file.extension().string());
    list->push_back({"file://" + file.string(), is_mesh ? "mesh, as a body" : "model", {}});
  }
}

}  // namespace

SpawnResult Operator::spawn(const SpawnRequest& request) {
  Private& p = *private_;
  if (const Status world = p.need_world(); !world.ok())
    return failed(SpawnFailure::kOther, world.error());
  if (!request.name.empty() && !is_name(request.name))
    return failed(SpawnFailure::kNameInvalid,
                  "a name has up to 128 letters, digits, '_', '-' and '.'");
  if (!request.ns.empty() && !is_namespace(request.ns))
    return failed(SpawnFailure::kNamespaceInvalid,
                  fmt::format("'{:.100}' is no namespace of ROS", request.ns));
  Pose X_FE = request.X_FE;
  if (!is_finite(X_FE.p) || !normalize(&X_FE.q))
    return failed(SpawnFailure::kPoseInvalid,
                  "the pose has no unit quaternion, or numbers that are not finite");
  Pose X_WE = X_FE;
  if (!request.frame.empty() && request.frame != "world") {
    const Result<Body> body = simulation_.world().find_body(request.frame);
    if (!body.ok()) return failed(SpawnFailure::kPoseInvalid, body.error());
    const Result<Pose> X_WF = simulation_.body_pose(*body);
    if (!X_WF.ok()) return failed(SpawnFailure::kPoseInvalid, X_WF.error());
    X_WE = product(*X_WF, X_FE);
  }
  const std::lock_guard one_at_a_time(p.change_mutex);
  Scene scene = written_scene(simulation_.world());
  if (!scene.bare_model.empty())
    return failed(SpawnFailure::kOther,
                  Error{ErrorKind::kUnsupported,
                        "a bare model takes nothing more",
                        {},
                        "run a scene: [environment] or [[robot]] with this file"});
  SpawnFailure failure = SpawnFailure::kOther;
  std::string model_name;
  Result<SceneEntity> entity = p.source.find(request, scene, X_WE, &model_name, &failure);
  if (!entity.ok()) return failed(failure, entity.error());

  const std::vector<Entity> all = entities();
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::find(all, name, &Entity::name) != all.end() ||
           simulation_.world().find_body(name).ok();
  };
  std::string name =
      request.name.empty() ? default_name(*entity, model_name, p.source) : request.name;
  if (name.empty() && !request.allow_renaming)
    return failed(SpawnFailure::kNameInvalid, "neither the request nor the model has a name");
  if (name.empty()) name = "entity";
  if (is_taken(name)) {
    if (!request.allow_renaming)
      return failed(SpawnFailure::kNameTaken, fmt::format("there is an entity '{}' already", name));
    int number = 2;
    while (is_taken(fmt::format("{}_{}", name, number))) ++number;
    name = fmt::format("{}_{}", name, number);
  }
  {
    const std::lock_guard lock(p.names_mutex);
    if (p.spawned.size() >= kMostSpawned)
      return failed(SpawnFailure::kOther, "1000 entities were spawned, no more are");
  }
  add_to_scene(std::move(*entity), name, &scene);
  Result<World> world = World::compile(scene);
  if (world.ok() && !request.ns.empty()) {
    if (const Status renamed = rename_topics(*world, name, request.ns, &scene); !renamed.ok())
      return failed(SpawnFailure::kNamespaceInvalid, renamed.error());
    world = World::compile(scene);
    if (world.ok())
      if (const auto topics = list_topics(*world); !topics.ok())
        return failed(SpawnFailure::kNamespaceInvalid, topics.error());
  }
  if (!world.ok()) return failed(cause_of(world.error()), world.error());
  if (const Status status = simulation_.recompile(*world); !status.ok())
    return failed(SpawnFailure::kOther, status.error());
  const std::lock_guard lock(p.names_mutex);
  p.spawned.insert(name);
  p.infos.erase(name);
  return {.name = name};
}

Status Operator::remove(std::string_view name) {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  GLOAM_TRY_STATUS(find_entity(name));
  const std::lock_guard one_at_a_time(p.change_mutex);
  Scene scene = written_scene(simulation_.world());
  const bool known = erase_named(name, &scene.robots) || erase_named(name, &scene.objects) ||
                     erase_named(name, &scene.props) || erase_named(name, &scene.agents);
  if (!known)
    return Error{ErrorKind::kUnsupported,
                 fmt::format("'{}' is part of a file or a generated place", name),
                 {},
                 "robots, objects, props and agents of the scene can be removed"};
  std::string token(name);
  std::ranges::replace_if(token, [](unsigned char c) { return !std::isalnum(c); }, '_');
  std::erase_if(scene.topics, [&](const TopicOptions& o) {
    return o.name.starts_with("/" + token + "/") && o.loc.line == 0;
  });
  GLOAM_TRY_STATUS(p.exchange(scene));
  const std::lock_guard lock(p.names_mutex);
  p.spawned.erase(std::string(name));
  p.infos.erase(std::string(name));
  return {};
}

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

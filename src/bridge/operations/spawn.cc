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

// Cause of a failed compile, from its message: MuJoCo and Gloam report missing files alike.
SpawnFailure cause_of(const Error& error) {
  const auto says = [&](std::initializer_list<const char*> words) {
    return std::ranges::any_of(
        words, [&](const char* word) { return error.message.find(word) != std::string::npos; });
  };
  if (error.kind == ErrorKind::kUsage) return SpawnFailure::kOther;
  if (says({"there is no file", "does not exist", "outside the folder", "could not open",
            "cannot be read", "cannot open", "is not known"}))
    return SpawnFailure::kMissingAssets;
  if (error.kind == ErrorKind::kUnsupported || says({"no decoder found"}))
    return SpawnFailure::kUnsupportedAssets;
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

// Errors of a request by itself.
SpawnResult check_request(const SpawnRequest& request) {
  if (!request.name.empty() && !is_name(request.name))
    return failed(SpawnFailure::kNameInvalid,
                  "a name may contain up to 128 letters, digits, '_', '-' and '.'");
  if (!request.ns.empty() && !is_namespace(request.ns))
    return failed(SpawnFailure::kNamespaceInvalid,
                  fmt::format("'{:.100}' is not a valid ROS namespace", request.ns));
  return {};
}

Result<Pose> find_pose(const SpawnRequest& request, Simulation& simulation) {
  Pose X_FE = request.X_FE;
  if (!is_finite(X_FE.p) || !normalize(&X_FE.q))
    return Error{ErrorKind::kInput,
                 "the pose is not finite, or its orientation is not a unit quaternion"};
  if (request.frame.empty() || request.frame == "world") return X_FE;
  GLOAM_TRY(const Body body, simulation.world().find_body(request.frame));
  GLOAM_TRY(const Pose X_WF, simulation.body_pose(body));
  return product(X_WF, X_FE);
}

// The name that is asked for, or the resource's own, or a free one after it.
SpawnResult choose_name(const SpawnRequest& request, const std::string& own,
                        const std::vector<Entity>& entities, const World& world) {
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::find(entities, name, &Entity::name) != entities.end() ||
           world.find_body(name).ok();
  };
  std::string name = request.name.empty() ? own : request.name;
  if (name.empty() && !request.allow_renaming)
    return failed(SpawnFailure::kNameInvalid, "neither the request nor the model has a name");
  if (name.empty()) name = "entity";
  if (!is_taken(name)) return {.name = name};
  if (!request.allow_renaming)
    return failed(SpawnFailure::kNameTaken, fmt::format("an entity '{}' already exists", name));
  int number = 2;
  while (is_taken(fmt::format("{}_{}", name, number))) ++number;
  return {.name = fmt::format("{}_{}", name, number)};
}

// The World of a scene with the new entity, its topics by its namespace.
Result<World> compile_with(const std::string& name, const std::string& ns, Scene* scene,
                           SpawnFailure* failure) {
  Result<World> world = World::compile(*scene);
  if (world.ok() && !ns.empty()) {
    *failure = SpawnFailure::kNamespaceInvalid;
    GLOAM_TRY_STATUS(rename_topics(*world, name, ns, scene));
    world = World::compile(*scene);
  }
  if (!world.ok()) {
    *failure = cause_of(world.error());
    return world;
  }
  *failure = SpawnFailure::kParse;
  for (const RobotInfo& robot : world->robots())
    if (robot.name == name && robot.root.id <= 0)
      return Error{ErrorKind::kInput, "the model has no body"};
  // Names of topics have fewer characters: two entities may have one.
  *failure = ns.empty() ? SpawnFailure::kNameTaken : SpawnFailure::kNamespaceInvalid;
  GLOAM_TRY_STATUS(list_topics(*world));
  return world;
}

}  // namespace

SpawnResult Operator::spawn(const SpawnRequest& request) {
  Private& p = *private_;
  if (const Status world = p.need_world(); !world.ok())
    return failed(SpawnFailure::kOther, world.error());
  if (const SpawnResult checked = check_request(request); !checked.ok()) return checked;
  const Result<Pose> X_WE = find_pose(request, simulation_);
  if (!X_WE.ok()) return failed(SpawnFailure::kPoseInvalid, X_WE.error());

  const std::lock_guard one_at_a_time(p.change_mutex);
  Scene scene = written_scene(simulation_.world());
  if (!scene.bare_model.empty())
    return failed(SpawnFailure::kOther,
                  Error{ErrorKind::kUnsupported,
                        "entities cannot be added to a bare model",
                        {},
                        "run a scene: [environment] or [[robot]] with this file"});
  if (p.spawned_count() >= kMostSpawned)
    return failed(SpawnFailure::kOther, "the limit of 1000 spawned entities has been reached");
  SpawnFailure failure = SpawnFailure::kOther;
  std::string model_name;
  Result<SceneEntity> entity = p.source.find(request, scene, *X_WE, &model_name, &failure);
  if (!entity.ok()) return failed(failure, entity.error());
  SpawnResult result = choose_name(request, default_name(*entity, model_name, p.source), entities(),
                                   simulation_.world());
  if (!result.ok()) return result;
  add_to_scene(std::move(*entity), result.name, &scene);
  const Result<World> world = compile_with(result.name, request.ns, &scene, &failure);
  if (!world.ok()) return failed(failure, world.error());
  if (const Status status = simulation_.recompile(*world); !status.ok())
    return failed(SpawnFailure::kOther, status.error());
  const std::lock_guard lock(p.names_mutex);
  p.spawned.insert(result.name);
  p.infos.erase(result.name);
  return result;
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
                 "only robots, objects, props and agents of the scene can be removed"};
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

}  // namespace gloam::bridge

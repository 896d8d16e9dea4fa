// Operations on the World: entities, spawning, scenes.

#include <algorithm>

#include "bridge/zmq/operations/operation.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

void pack_vector(Packer& out, std::string_view key, const Vec3& v) {
  const double numbers[] = {v.x, v.y, v.z};
  out.pack(key);
  pack_numbers(out, numbers);
}

void pack_pose(Packer& out, const Pose& X) {
  const double quaternion[] = {X.q.w, X.q.x, X.q.y, X.q.z};
  pack_vector(out, "position", X.p);
  out.pack(std::string_view("orientation"));
  pack_numbers(out, quaternion);
}

const char* entity_kind_name(EntityKind kind) {
  static constexpr const char* kNames[] = {"object", "robot", "human", "dynamic", "static"};
  return kNames[static_cast<size_t>(kind)];
}

Vec3 vector_argument(const Call& call, std::string_view name) {
  const std::vector<double> v = call.arguments.numbers(name);
  return v.size() == 3 ? Vec3{v[0], v[1], v[2]} : Vec3{};
}

Pose pose_argument(const Call& call) {
  Pose X = {.p = vector_argument(call, "position")};
  if (const auto q = call.arguments.numbers("orientation"); q.size() == 4)
    X.q = {q[0], q[1], q[2], q[3]};
  return X;
}

void pack_entity(Packer& out, const Entity& entity) {
  out.pack_map(6);
  pack_pair(out, "name", entity.name);
  pack_pair(out, "kind", std::string_view(entity_kind_name(entity.category())));
  pack_pair(out, "floats", entity.joint >= 0);
  pack_pair(out, "spawned", entity.is_spawned);
  pack_pair(out, "description", entity.description);
  pack_pair(out, "tags", entity.tags);
}

Status entities(const Call& call, Packer& out) {
  const std::vector<Entity> all = call.services.operations().entities();
  out.pack_array(static_cast<uint32_t>(all.size()));
  for (const Entity& entity : all) pack_entity(out, entity);
  return {};
}

Status entity_state(const Call& call, Packer& out) {
  const std::string name = call.arguments.text("name");
  GLOAM_TRY(const EntityState state, call.services.operations().entity_state(name));
  GLOAM_TRY(const Box box, call.services.operations().entity_bounds(name));
  out.pack_map(8);
  pack_pose(out, state.X_WE);
  pack_vector(out, "velocity", state.velocity);
  pack_vector(out, "angular_velocity", state.angular_velocity);
  pack_vector(out, "acceleration", state.acceleration);
  pack_vector(out, "angular_acceleration", state.angular_acceleration);
  pack_vector(out, "box_low", box.low);
  pack_vector(out, "box_high", box.high);
  return {};
}

Status set_entity_state(const Call& call, Packer& out) {
  StateChange change;
  if (call.arguments.has("orientation") && !call.arguments.has("position"))
    return Error{ErrorKind::kUsage, "'orientation' requires 'position'"};
  if (call.arguments.has("position")) change.X_WE = pose_argument(call);
  if (call.arguments.has("velocity")) change.velocity = vector_argument(call, "velocity");
  if (call.arguments.has("angular_velocity"))
    change.angular_velocity = vector_argument(call, "angular_velocity");
  GLOAM_TRY_STATUS(
      call.services.operations().set_entity_state(call.arguments.text("name"), change));
  pack_nothing(out);
  return {};
}

Status spawn(const Call& call, Packer& out) {
  SpawnRequest request{.name = call.arguments.text("name"),
                       .allow_renaming = call.arguments.flag("allow_renaming"),
                       .uri = call.arguments.text("uri"),
                       .text = call.arguments.text("text"),
                       .ns = call.arguments.text("namespace"),
                       .frame = call.arguments.text("frame"),
                       .X_FE = pose_argument(call)};
  SpawnResult result = call.services.operations().spawn(request);
  if (!result.ok()) return std::move(result.error);
  out.pack_map(1);
  pack_pair(out, "name", result.name);
  return {};
}

Status remove_entity(const Call& call, Packer& out) {
  GLOAM_TRY_STATUS(call.services.operations().remove(call.arguments.text("name")));
  pack_nothing(out);
  return {};
}

Status named_poses(const Call& call, Packer& out) {
  const std::vector<NamedPose> poses = call.services.operations().named_poses();
  out.pack_array(static_cast<uint32_t>(poses.size()));
  for (const NamedPose& pose : poses) {
    out.pack_map(4);
    pack_pair(out, "name", pose.name);
    pack_pair(out, "description", pose.description);
    pack_pose(out, pose.X_WP);
  }
  return {};
}

Status spawnables(const Call& call, Packer& out) {
  GLOAM_TRY(const std::vector<Spawnable> all, call.services.operations().spawnables());
  out.pack_array(static_cast<uint32_t>(all.size()));
  for (const Spawnable& each : all) {
    out.pack_map(3);
    pack_pair(out, "uri", each.uri);
    pack_pair(out, "description", each.description);
    pack_vector(out, "size", each.size);
  }
  return {};
}

void pack_world(Packer& out, const WorldFile& world) {
  out.pack_map(3);
  pack_pair(out, "name", world.name);
  pack_pair(out, "uri", world.uri);
  pack_pair(out, "description", world.description);
}

Status worlds(const Call& call, Packer& out) {
  GLOAM_TRY(const std::vector<WorldFile> all, call.services.operations().worlds());
  out.pack_array(static_cast<uint32_t>(all.size()));
  for (const WorldFile& each : all) pack_world(out, each);
  return {};
}

Status load_world(const Call& call, Packer& out) {
  GLOAM_TRY(const WorldFile world, call.services.operations().load_world(
                                       call.arguments.text("uri"), call.arguments.text("text")));
  pack_world(out, world);
  return {};
}

}  // namespace

std::vector<Operation> world_operations() {
  const Argument name{"name", kText, true, "", "name of an entity"};
  const Argument position{"position", kNumbers, false, "m, (3)", "x y z", 3};
  const Argument orientation{"orientation", kNumbers, false, "(4)", "unit quaternion w x y z", 4};
  return {
      {"entities", "robots, people, vehicles, objects: [{name, kind, …}]", kQueued, {}, entities},
      {"entity_state",
       "pose, velocities, accelerations, box; world axes",
       kQueued,
       {name},
       entity_state},
      {"set_entity_state",
       "sets the state of a floating entity or the pose of a mocap body",
       kQueued,
       {name,
        position,
        orientation,
        {"velocity", kNumbers, false, "m/s, (3)", "world axes", 3},
        {"angular_velocity", kNumbers, false, "rad/s, (3)", "world axes", 3}},
       set_entity_state},
      {"spawn",
       "adds an entity: {name}; the scene is recompiled and the run continues",
       kQueued,
       {{"uri", kText, false, "", "an MJCF, URDF or mesh file, or gloam://prop/KIND"},
        {"text", kText, false, "", "the MJCF or URDF text, instead of 'uri'"},
        {"name", kText, false, "", "default: derived from the file name"},
        {"allow_renaming", kBool, false, "", "use NAME_2 … if NAME is in use"},
        {"namespace", kText, false, "", "namespace of a robot's topics; default: /NAME"},
        {"frame", kText, false, "", "body that the pose is relative to; default: the world"},
        position,
        orientation},
       spawn},
      {"remove", "removes an entity; the scene is recompiled", kQueued, {name}, remove_entity},
      {"named_poses", "lists the named places: [{name, position, …}]", kQueued, {}, named_poses},
      {"spawnables",
       "lists the models that 'spawn' can add: [{uri, description, size}]",
       kQueued,
       {},
       spawnables},
      {"worlds",
       "lists the scenes that 'load_world' can load: [{name, uri, …}]",
       kQueued,
       {},
       worlds},
      {"load_world",
       "loads another scene, stopped at its first instant",
       kQueued,
       {{"uri", kText, false, "", "name listed by 'worlds', path or file:// address"},
        {"text", kText, false, "", "the text of the scene in TOML"}},
       load_world},
  };
}

}  // namespace gloam::bridge::zeromq

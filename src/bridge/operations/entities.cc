// Operator: entities as clients see them, their states and how they change.

#include <fmt/format.h>

#include <algorithm>

#include "bridge/operations/operator_private.h"
#include "bridge/operations/pose_math.h"
#include "gloam/program.h"

namespace gloam::bridge {
namespace {

constexpr size_t kMostTags = 64, kLongestText = 4096;

Error no_entity(std::string_view name, const std::vector<Entity>& entities) {
  std::vector<std::string> names;
  for (const Entity& entity : entities) names.push_back(entity.name);
  return Error{ErrorKind::kInput,
               fmt::format("there is no entity '{}'", name.substr(0, 100)),
               {},
               suggest_name(name, names)};
}

const Entity* find_by_name(std::string_view name, const std::vector<Entity>& entities) {
  const auto found = std::ranges::find(entities, name, &Entity::name);
  return found == entities.end() ? nullptr : &*found;
}

/// Numbers of a free joint that a change sets; the rest is what it is now.
Result<Command> joint_command(const Entity& entity, const StateChange& change,
                              const EntityState& now) {
  SetJointState set{{entity.joint, entity.body.world}, {}, {}};
  const Pose X = change.X_WE.value_or(now.X_WE);
  if (change.X_WE) set.qpos = {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z};
  if (change.velocity || change.angular_velocity) {
    const Vec3 v = change.velocity.value_or(now.velocity);
    // MuJoCo counts the angular velocity of a free joint in the body's axes.
    const Vec3 w = rotate(inverse(X.q), change.angular_velocity.value_or(now.angular_velocity));
    set.qvel = {v.x, v.y, v.z, w.x, w.y, w.z};
  }
  return Command{.what = std::move(set)};
}

Error cannot_move(const Entity& entity) {
  const std::string cause = entity.is_agent ? "moves by itself"
                            : entity.kind == EntityKind::kRobot
                                ? "has a fixed base"
                                : "is fixed to the world or attached by joints";
  return Error{ErrorKind::kUnsupported,
               fmt::format("the pose of entity '{}' cannot be set: it {}", entity.name, cause),
               {},
               "only free-floating entities and mocap bodies can be moved"};
}

Status check_change(StateChange* change) {
  if (change->X_WE && (!is_finite(change->X_WE->p) || !normalize(&change->X_WE->q)))
    return Error{ErrorKind::kInput,
                 "the pose is not finite, or its orientation is not a unit quaternion"};
  for (const auto* v : {&change->velocity, &change->angular_velocity})
    if (*v && !is_finite(**v)) return Error{ErrorKind::kInput, "the velocity is not finite"};
  return {};
}

}  // namespace

Status Operator::Private::solve() {
  const Snapshot snapshot = simulation.latest();
  if (solved == nullptr) solved = std::make_unique<Solved>();
  Solved& s = *solved;
  if (s.snapshot && &s.snapshot.data() == &snapshot.data()) return {};
  s.snapshot = {};
  GLOAM_TRY_STATUS(s.instant.solve(snapshot));
  const World world = snapshot.world();
  if (s.world != world.compiled().get()) {
    s.world = nullptr;
    GLOAM_TRY(s.entities, list_entities(world, s.instant));
    s.world = world.compiled().get();
  }
  s.snapshot = snapshot;
  return {};
}

std::vector<Entity> Operator::entities() const {
  std::vector<Entity> entities;
  {
    const std::lock_guard lock(private_->solved_mutex);
    if (!private_->solve().ok()) return {};
    entities = private_->solved->entities;
  }
  const std::lock_guard lock(private_->names_mutex);
  for (Entity& entity : entities) {
    entity.is_spawned = private_->spawned.contains(entity.name);
    const auto info = private_->infos.find(entity.name);
    if (info == private_->infos.end()) continue;
    entity.description = info->second.description;
    entity.tags = info->second.tags;
    entity.shown_as = info->second.kind;
  }
  return entities;
}

Result<Entity> Operator::find_entity(std::string_view name) const {
  const std::vector<Entity> all = entities();
  const Entity* found = find_by_name(name, all);
  if (found == nullptr) return no_entity(name, all);
  return *found;
}

Status Operator::set_info(std::string_view name, std::string description,
                          std::vector<std::string> tags, EntityKind kind) {
  GLOAM_TRY_STATUS(find_entity(name));
  const auto is_long = [](const std::string& text) { return text.size() > kLongestText; };
  if (tags.size() > kMostTags || is_long(description) || std::ranges::any_of(tags, is_long))
    return Error{ErrorKind::kInput, "more than 64 tags, or a text of more than 4096 characters"};
  const std::lock_guard lock(private_->names_mutex);
  private_->infos.insert_or_assign(std::string(name),
                                   Private::Info{std::move(description), std::move(tags), kind});
  return {};
}

Result<std::vector<EntityState>> Operator::entity_states(
    const std::vector<Entity>& entities) const {
  std::vector<EntityState> states;
  const std::lock_guard lock(private_->solved_mutex);
  GLOAM_TRY_STATUS(private_->solve());
  const Private::Solved& solved = *private_->solved;
  const std::lock_guard names(private_->names_mutex);
  for (const Entity& entity : entities) {
    const Entity* now = find_by_name(entity.name, solved.entities);  // after a recompile another
    if (now == nullptr) return no_entity(entity.name, solved.entities);
    GLOAM_TRY(EntityState state, read_state(solved.instant, *now));
    const auto waits = private_->waiting.find(entity.name);
    if (waits != private_->waiting.end() && waits->second.step == solved.snapshot.step() &&
        waits->second.hash == solved.snapshot.hash()) {
      const StateChange& change = waits->second.change;
      state.X_WE = change.X_WE.value_or(state.X_WE);
      state.velocity = change.velocity.value_or(state.velocity);
      state.angular_velocity = change.angular_velocity.value_or(state.angular_velocity);
    }
    states.push_back(state);
  }
  return states;
}

Result<EntityState> Operator::entity_state(std::string_view name) const {
  GLOAM_TRY(Entity entity, find_entity(name));
  GLOAM_TRY(const std::vector<EntityState> states, entity_states({std::move(entity)}));
  return states.front();
}

Status Operator::set_entity_state(std::string_view name, const StateChange& asked) {
  StateChange change = asked;
  GLOAM_TRY_STATUS(check_change(&change));
  GLOAM_TRY(const Entity entity, find_entity(name));
  if (entity.joint < 0 && !entity.is_mocap) return cannot_move(entity);
  if (!change.X_WE && !change.velocity && !change.angular_velocity) return {};
  GLOAM_TRY(const EntityState now, entity_state(name));
  const Snapshot at = simulation_.latest();
  Command command;
  if (entity.joint >= 0) {
    GLOAM_TRY(command, joint_command(entity, change, now));
  } else if (change.velocity || change.angular_velocity) {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("entity '{}' is a mocap body, which has no velocity", entity.name),
                 {},
                 "set only its pose"};
  } else {
    command.what = SetMocapPose{entity.body, *change.X_WE};
  }
  GLOAM_TRY_STATUS(simulation_.post(command));
  const std::lock_guard lock(private_->names_mutex);
  Private::Waiting& waiting = private_->waiting[entity.name];
  const bool adds = waiting.step == at.step() && waiting.hash == at.hash();
  if (!adds) waiting.change = {};
  waiting.step = at.step();
  waiting.hash = at.hash();
  if (change.X_WE) waiting.change.X_WE = change.X_WE;
  if (change.velocity) waiting.change.velocity = change.velocity;
  if (change.angular_velocity) waiting.change.angular_velocity = change.angular_velocity;
  return {};
}

Result<std::vector<Box>> Operator::entity_bounds(const std::vector<Entity>& entities,
                                                 BoxFrame frame) const {
  const std::lock_guard lock(private_->solved_mutex);
  GLOAM_TRY_STATUS(private_->solve());
  std::vector<Entity> now;
  for (const Entity& entity : entities) {
    const Entity* found = find_by_name(entity.name, private_->solved->entities);
    if (found == nullptr) return no_entity(entity.name, private_->solved->entities);
    now.push_back(*found);
  }
  return read_boxes(private_->solved->instant, now, frame);
}

Result<Box> Operator::entity_bounds(std::string_view name, BoxFrame frame) const {
  GLOAM_TRY(Entity entity, find_entity(name));
  GLOAM_TRY(const std::vector<Box> boxes, entity_bounds(std::vector{std::move(entity)}, frame));
  return boxes.front();
}

std::vector<NamedPose> Operator::named_poses() const {
  return list_named_poses(simulation_.world());
}

}  // namespace gloam::bridge

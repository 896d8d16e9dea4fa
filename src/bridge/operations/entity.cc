#include "bridge/operations/entity.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "bridge/operations/pose_math.h"

namespace gloam::bridge {
namespace {

constexpr double kFreeJoint = 0, kPlane = 0;  // mjtJoint, mjtGeom

/// Arrays of the model that determine the moving bodies.
struct BodyFacts {
  std::vector<double> joints, first_joint, mocap, joint_type;

  static Result<BodyFacts> read(const Instant& instant) {
    BodyFacts facts;
    GLOAM_TRY(facts.joints, instant.value("body_jntnum"));
    GLOAM_TRY(facts.first_joint, instant.value("body_jntadr"));
    GLOAM_TRY(facts.mocap, instant.value("body_mocapid"));
    GLOAM_TRY(facts.joint_type, instant.value("jnt_type"));
    return facts;
  }
  int free_joint(size_t body) const {
    if (joints[body] < 1) return -1;
    const auto joint = static_cast<size_t>(first_joint[body]);
    return joint_type[joint] == kFreeJoint ? static_cast<int>(joint) : -1;
  }
};

/// Bodies of an entity: those below its root.
std::vector<int> entity_of_body(const std::vector<double>& parents,
                                const std::vector<Entity>& entities) {
  std::vector<int> owner(parents.size(), -1);
  for (size_t i = 0; i < entities.size(); ++i)
    owner[static_cast<size_t>(entities[i].body.id)] = static_cast<int>(i);
  for (size_t body = 1; body < parents.size(); ++body)  // parents come first
    if (owner[body] < 0) owner[body] = owner[static_cast<size_t>(parents[body])];
  return owner;
}

bool moves_itself(const BodyFacts& facts, const std::vector<double>& parents, int root) {
  std::vector<bool> below(parents.size());
  below[static_cast<size_t>(root)] = true;
  for (size_t body = 1; body < parents.size(); ++body) {
    if (!below[body]) below[body] = below[static_cast<size_t>(parents[body])];
    if (!below[body]) continue;
    const int count = static_cast<int>(facts.joints[body]);
    if (count > 0 && (facts.free_joint(body) < 0 || count > 1)) return true;
  }
  return false;
}

std::string describe(EntityKind kind, bool is_agent) {
  switch (kind) {
    case EntityKind::kRobot:
      return "robot";
    case EntityKind::kHuman:
      return "person";
    case EntityKind::kDynamic:
      return is_agent ? "vehicle" : "externally controlled body";
    case EntityKind::kStatic:
      return "fixed body";
    default:
      return "object";
  }
}

/// A box around a geom, in the geom's axes.
struct GeomBox {
  Vec3 p_W;           // origin of the geom [m]
  Vec3 axes_W[3];     // unit
  const double* box;  // centre and half sizes

  /// Widens a box in frame E until it holds this one.
  void join(const Pose& X_WE, Box* around) const {
    const Quat q_EW = inverse(X_WE.q);
    Vec3 centre = difference(p_W, X_WE.p), half = {};
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 &a = axes_W[k], side = rotate(q_EW, a);
      centre = sum(centre, {a.x * box[k], a.y * box[k], a.z * box[k]});
      half = sum(half, {std::abs(side.x) * box[3 + k], std::abs(side.y) * box[3 + k],
                        std::abs(side.z) * box[3 + k]});
    }
    centre = rotate(q_EW, centre);
    const Vec3 low = difference(centre, half), high = sum(centre, half);
    if (around->is_empty()) *around = {low, high};
    around->low = {std::min(around->low.x, low.x), std::min(around->low.y, low.y),
                   std::min(around->low.z, low.z)};
    around->high = {std::max(around->high.x, high.x), std::max(around->high.y, high.y),
                    std::max(around->high.z, high.z)};
  }
};

/// Names in the World.
struct KnownNames {
  std::set<std::string> mocap;              // that clients may move
  std::map<std::string, std::string> kind;  // of agents
  std::map<int, std::string> robot;         // name by root body
  std::map<int, bool> has_actuators;

  explicit KnownNames(const World& world) {
    for (const InputInfo& input : world.inputs())
      if (input.kind == InputKind::kMocap) mocap.insert(input.name);
    for (const AgentOptions& agent : world.scene().agents) kind[agent.name] = agent.kind;
    for (const RobotInfo& info : world.robots()) {
      robot[info.root.id] = info.name;
      has_actuators[info.root.id] = !info.actuators.empty();
    }
  }
};

}  // namespace

Result<std::vector<Entity>> list_entities(const World& world, const Instant& instant) {
  GLOAM_TRY(const BodyFacts facts, BodyFacts::read(instant));
  GLOAM_TRY(const std::vector<double> parents, instant.value("body_parentid"));
  const KnownNames known(world);
  std::vector<Entity> entities;
  std::set<std::string> taken;
  for (const BodyInfo& info : world.bodies()) {
    const int id = info.body.id;
    const auto robot = known.robot.find(id);
    const bool is_robot = robot != known.robot.end() && id > 0;
    if (id == 0 || (info.parent.id != 0 && !is_robot)) continue;
    Entity entity{.name = is_robot ? robot->second : info.name, .body = info.body};
    if (entity.name.empty()) entity.name = info.name;
    if (entity.name.empty()) entity.name = fmt::format("body_{}", id);
    const auto row = static_cast<size_t>(id);
    entity.joint = facts.free_joint(row);
    const bool mocap = facts.mocap[row] >= 0;
    entity.is_mocap = mocap && known.mocap.contains(entity.name);
    entity.is_agent = mocap && !entity.is_mocap;
    // Limbs of people and forks of forklifts are bodies of their own: "NAME/PART".
    if (entity.is_agent && taken.contains(entity.name.substr(0, entity.name.rfind('/')))) continue;
    const bool has_joints = moves_itself(facts, parents, id);
    if (is_robot && (known.has_actuators.at(id) || has_joints)) {
      entity.kind = EntityKind::kRobot;
    } else if (entity.is_agent) {
      const auto kind = known.kind.find(entity.name);
      const bool is_person = kind == known.kind.end() || kind->second == "person";
      entity.kind = is_person ? EntityKind::kHuman : EntityKind::kDynamic;
    } else if (mocap) {
      entity.kind = EntityKind::kDynamic;
    } else {
      const bool moves = entity.joint >= 0 || has_joints;
      entity.kind = moves ? EntityKind::kObject : EntityKind::kStatic;
    }
    entity.description = describe(entity.kind, entity.is_agent);
    if (taken.insert(entity.name).second) entities.push_back(std::move(entity));
  }
  return entities;
}

Result<EntityState> read_state(const Instant& instant, const Entity& entity) {
  GLOAM_TRY(const BodyState body, instant.body(entity.body));
  EntityState state{
      .X_WE = body.X_WB, .velocity = body.velocity, .angular_velocity = body.angular_velocity};
  // Spatial accelerations are at the centre of mass of the body's tree, and hold minus gravity
  // (MuJoCo: mj_objectAcceleration).
  GLOAM_TRY(const std::vector<double> all, instant.value("cacc"));
  GLOAM_TRY(const std::vector<double> centres, instant.value("subtree_com"));
  GLOAM_TRY(const std::vector<double> roots, instant.value("body_rootid"));
  GLOAM_TRY(const std::vector<double> gravity, instant.value("opt.gravity"));
  const auto id = static_cast<size_t>(entity.body.id);
  const double* a = all.data() + 6 * id;
  const double* c = centres.data() + 3 * static_cast<size_t>(roots[id]);
  state.angular_acceleration = {a[0], a[1], a[2]};
  const Vec3 arm = difference(body.X_WB.p, {c[0], c[1], c[2]});
  Vec3 linear = sum({a[3], a[4], a[5]}, cross(state.angular_acceleration, arm));
  linear = sum(linear, cross(body.angular_velocity, body.velocity));
  if (gravity.size() == 3) linear = sum(linear, {gravity[0], gravity[1], gravity[2]});
  state.acceleration = linear;
  return state;
}

Result<std::vector<Box>> read_boxes(const Instant& instant, const std::vector<Entity>& entities,
                                    BoxFrame frame) {
  GLOAM_TRY(const std::vector<double> parents, instant.value("body_parentid"));
  GLOAM_TRY(const std::vector<double> bodies, instant.value("geom_bodyid"));
  GLOAM_TRY(const std::vector<double> types, instant.value("geom_type"));
  GLOAM_TRY(const std::vector<double> boxes, instant.value("geom_aabb"));
  GLOAM_TRY(const std::vector<double> places, instant.value("geom_xpos"));
  GLOAM_TRY(const std::vector<double> turns, instant.value("geom_xmat"));
  const std::vector<int> owners = entity_of_body(parents, entities);
  std::vector<Pose> X_WE(entities.size());
  for (size_t i = 0; i < entities.size() && frame == BoxFrame::kEntity; ++i) {
    GLOAM_TRY(const BodyState body, instant.body(entities[i].body));
    X_WE[i] = body.X_WB;
  }
  std::vector<Box> all(entities.size());
  for (size_t geom = 0; geom < bodies.size(); ++geom) {
    const int owner = owners[static_cast<size_t>(bodies[geom])];
    if (owner < 0 || types[geom] == kPlane) continue;
    const double *R = turns.data() + 9 * geom, *p = places.data() + 3 * geom;
    const GeomBox box = {{p[0], p[1], p[2]},
                         {Vec3{R[0], R[3], R[6]}, Vec3{R[1], R[4], R[7]}, Vec3{R[2], R[5], R[8]}},
                         boxes.data() + 6 * geom};
    box.join(X_WE[static_cast<size_t>(owner)], &all[static_cast<size_t>(owner)]);
  }
  return all;
}

std::vector<NamedPose> list_named_poses(const World& world) {
  std::vector<NamedPose> poses;
  std::map<std::string, int> seen;
  const auto unique = [&](const std::string& name) {
    const int count = ++seen[name];
    return count == 1 ? name : fmt::format("{}_{}", name, count);
  };
  for (const Region& region : world.info().regions) {
    const Vec3 middle = {(region.low.x + region.high.x) / 2, (region.low.y + region.high.y) / 2,
                         region.low.z};
    poses.push_back({unique(region.name),
                     "centre of the floor",
                     {"region", region.label},
                     {middle, {}},
                     {region.low, region.high},
                     0});
  }
  for (const GoalOptions& goal : world.scene().goals)
    poses.push_back({unique(goal.robot.empty() || goal.robot.find('*') != std::string::npos
                                ? "goal"
                                : goal.robot + "_goal"),
                     "goal of robot " + goal.robot,
                     {"goal"},
                     {goal.position, {}},
                     {},
                     goal.radius});
  return poses;
}

}  // namespace gloam::bridge

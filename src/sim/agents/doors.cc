#include "sim/agents/doors.h"

#include "base/hash.h"

namespace gloam {
namespace {

constexpr double kApproachDistance = 1.8, kPushDistance = 1.15, kDoorwayDistance = 0.7;  // [m]
constexpr double kMinOpenFraction = 0.75;  // fraction of the way that a leaf has to be open
constexpr double kMaxPushTorque = 30;  // a hand's, at a metre (ISO 21542: doors open at 25 N) [N m]
constexpr double kStiffness = 40;      // [N m/rad]
constexpr double kDamping = 14;        // [N m s/rad]
// Back: the moment of a door closer of size 2 (EN 1154), 27 degrees a second, after two seconds.
constexpr double kMaxCloserTorque = 13, kCloserStiffness = 90, kCloserDamping = 28, kCloseDelay = 2;
constexpr double kShutAngle = 0.03;  // [rad]

}  // namespace

AgentDoors::AgentDoors(const CompiledWorld& world, const mjModel& m, const mjData& d) {
  std::vector<bool> of_robot(static_cast<size_t>(m.nbody));
  for (const RobotInstance& robot : world.robots)
    if (robot.root_body > 0) of_robot[static_cast<size_t>(robot.root_body)] = true;
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    if (of_robot[static_cast<size_t>(m.body_rootid[body])] || !is_door_leaf(m, d, body)) continue;
    const int joint = m.body_jntadr[body];
    Door door;
    door.qpos = m.jnt_qposadr[joint];
    door.dof = m.jnt_dofadr[joint];
    const mjtNum* range = m.jnt_range + 2 * joint;
    const bool is_limited = m.jnt_limited[joint] != 0;
    const double low = is_limited ? range[0] : -1.5, high = is_limited ? range[1] : 1.5;
    door.rest = d.qpos[door.qpos];
    door.open = 0.95 * (high > -low ? high : low);
    // The middle of the leaf when it is shut, its joint at zero.
    const mjtNum *anchor = d.xanchor + 3 * joint, *axis = d.xaxis + 3 * joint;
    double reach = 0;
    Vec3d leaf;
    for (int g = m.body_geomadr[body]; g < m.body_geomadr[body] + m.body_geomnum[body]; ++g) {
      if (m.geom_contype[g] == 0 || m.geom_rbound[g] <= reach) continue;
      reach = m.geom_rbound[g];
      leaf = {d.geom_xpos[3 * g] - anchor[0], d.geom_xpos[3 * g + 1] - anchor[1], 0};
    }
    const Quat shut = turn_z(-d.qpos[door.qpos] * axis[2]);
    const mjtNum* p = d.xpos + 3 * body;
    door.middle = Vec3d{anchor[0], anchor[1], p[2]} + rotated(shut, leaf);
    doors_.push_back(door);
  }
}

void AgentDoors::reset() {
  for (Door& door : doors_) door.state = {};
}

void AgentDoors::decide(const mjData& data, const std::vector<AgentBody>& agents,
                        std::span<const NavObstacle> obstacles, double dt) {
  for (Door& door : doors_) {
    Door::State& state = door.state;
    bool is_wanted = false, is_near = false;
    for (const AgentBody& agent : agents) {
      const Vec3d to = door.middle - agent.motion.p;
      if (std::abs(to.z) > 1.5) continue;
      const double away = flat_norm(to);
      const bool comes =
          agent.intent.mode != AgentIntent::Mode::kStand &&
          dot(flat(to), agent.motion.wanted) > 0.2 * away * norm(agent.motion.wanted);
      const bool waits = is_blocked(data, agent.motion);
      is_wanted |= away < kDoorwayDistance || (away < kApproachDistance && (comes || waits));
      is_near |= away < kApproachDistance;
    }
    for (const NavObstacle& o : obstacles)
      is_near |= o.is_robot && flat_norm(door.middle - o.p) < kApproachDistance + o.radius;
    state.is_wanted = is_wanted;
    state.was_opened |= is_wanted;
    state.idle = is_near ? 0 : state.idle + dt;
    const bool is_shut = std::abs(data.qpos[door.qpos] - door.rest) < kShutAngle;
    if (is_shut && !is_wanted && state.idle > kCloseDelay) state.was_opened = 0;
    state.is_closing = state.was_opened != 0 && !is_wanted && state.idle > kCloseDelay;
    state.is_driven |= state.was_opened;
  }
}

bool AgentDoors::is_blocked(const mjData& data, const AgentMotion& motion) const {
  for (const Door& door : doors_) {
    const Vec3d to = flat(door.middle - motion.p);
    const double away = norm(to);
    if (away > kPushDistance || away < 0.35 || std::abs(door.middle.z - motion.p.z) > 1.5) continue;
    if (data.qpos[door.qpos] / door.open >= kMinOpenFraction) continue;
    if (dot(to, heading_vector(motion.heading)) > 0.5 * away) return true;
  }
  return false;
}

void AgentDoors::drive(mjData* data) const {
  for (const Door& door : doors_) {
    if (door.state.is_driven == 0) continue;
    const double q = data->qpos[door.qpos], speed = data->qvel[door.dof];
    double torque = 0;
    if (door.state.is_wanted != 0)
      torque = std::clamp(kStiffness * (door.open - q) - kDamping * speed, -kMaxPushTorque,
                          kMaxPushTorque);
    else if (door.state.is_closing != 0)
      torque = std::clamp(kCloserStiffness * (door.rest - q), -kMaxCloserTorque, kMaxCloserTorque) -
               kCloserDamping * speed;
    data->qfrc_applied[door.dof] = torque;
  }
}

uint64_t AgentDoors::hash(uint64_t seed) const {
  for (const Door& door : doors_) seed = hash_bytes(&door.state, sizeof(door.state), seed);
  return seed;
}

}  // namespace gloam

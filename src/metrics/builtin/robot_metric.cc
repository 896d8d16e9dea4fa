#include "metrics/builtin/robot_metric.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/text.h"
#include "sim/commands/command_check.h"
#include "world/model_memory.h"
#include "world/model_names.h"
#include "world/world_robots.h"

namespace gloam {
namespace {

// A new family is a line here.
constexpr RobotMetricFactory kFamilies[] = {
    make_pose_metric,        make_velocity_metric, make_fall_metric,   make_visibility_metric,
    make_illuminance_metric, make_path_metric,     make_energy_metric, make_collision_metric,
    make_slip_metric,        make_servo_metric,    make_goal_metric,   make_electricity_metric,
};

// Reach of the robot's colliders, sideways from its base [m].
double reach_of(const mjModel& m, const MetricRobot& robot) {
  const DataPtr data = make_data(m);
  mj_kinematics(&m, data.get());
  double reach = 0;
  for (int g = 0; g < m.ngeom; ++g) {
    if (!robot.own_bodies[static_cast<size_t>(m.geom_bodyid[g])] ||
        !(m.geom_contype[g] | m.geom_conaffinity[g]))
      continue;
    const mjtNum *p = data->geom_xpos + 3 * g, *base = data->xpos + 3 * robot.root();
    reach = std::max(reach, std::hypot(p[0] - base[0], p[1] - base[1]) + m.geom_rbound[g]);
  }
  return reach;
}

// Its own by name, and those without one that drive its tree.
std::vector<int> actuators_of(const mjModel& m, const RobotInstance& robot) {
  std::vector<int> own = robot_actuators(m, robot);
  RobotInstance unnamed = robot;
  unnamed.prefix.clear();
  for (const int actuator : robot_actuators(m, unnamed)) {
    const bool is_new = std::ranges::find(own, actuator) == own.end();
    if (is_new && name_of(m, mjOBJ_ACTUATOR, actuator).empty()) own.push_back(actuator);
  }
  std::ranges::sort(own);
  return own;
}

bool root_slides(const mjModel& m, int root) {
  for (int j = 0; j < m.body_jntnum[root]; ++j) {
    const int type = m.jnt_type[m.body_jntadr[root] + j];
    if (type == mjJNT_FREE || type == mjJNT_SLIDE) return true;
  }
  return false;
}

}  // namespace

std::span<const RobotMetricFactory> robot_metrics() { return kFamilies; }

MetricRobot describe_robot(const CompiledWorld& world, int index, const MetricProbes& probes) {
  const mjModel& m = *world.model;
  MetricRobot robot;
  robot.world = &world;
  robot.instance = &world.robots[static_cast<size_t>(index)];
  robot.index = index;
  robot.probes = &probes;
  robot.own_bodies.assign(static_cast<size_t>(m.nbody), 0);
  const int root = robot.root();
  if (root <= 0) return robot;
  robot.base = floating_joint(m, root);
  robot.moves_about = robot.base >= 0 || root_slides(m, root);
  robot.actuators = actuators_of(m, *robot.instance);
  const std::string& prefix = robot.instance->prefix;
  for (int b = 1; b < m.nbody; ++b) {
    const bool below = is_part_of(m, b, root);
    const bool named = !prefix.empty() && name_of(m, mjOBJ_BODY, b).starts_with(prefix);
    robot.own_bodies[static_cast<size_t>(b)] = below || named;
    if (below || named) robot.mass += m.body_mass[b];
  }
  const bool measures_around = probes.visibility != nullptr || probes.illuminance != nullptr;
  if (measures_around && robot.base >= 0) robot.reach = reach_of(m, robot);
  for (const GoalOptions& goal : world.scene.goals) {
    if (goal.robot == robot.instance->name || fits_pattern(goal.robot, robot.instance->name))
      robot.goals.push_back(goal);
  }
  return robot;
}

Vec3 velocity_of_point(const MetricInstant& instant, int body, const Vec3& p_W) {
  mjtNum velocity[6];  // angular, linear, of the body's origin
  mj_objectVelocity(instant.model, instant.data, mjOBJ_XBODY, body, velocity, 0);
  const mjtNum* o = instant.data->xpos + 3 * body;
  const double r[3] = {p_W.x - o[0], p_W.y - o[1], p_W.z - o[2]};
  return {velocity[3] + velocity[1] * r[2] - velocity[2] * r[1],
          velocity[4] + velocity[2] * r[0] - velocity[0] * r[2],
          velocity[5] + velocity[0] * r[1] - velocity[1] * r[0]};
}

std::string unit_word(std::string_view unit) {
  if (unit == "%") return "percent";
  std::string word;
  for (const char c : unit) {
    if (c == '/') word += 'p';
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) || (c & 0x80);
    if (is_plain) word += c;
  }
  return word;
}

std::string with_unit(const std::string& name, std::string_view unit) {
  const std::string word = unit_word(unit);
  return word.empty() ? name : name + "_" + word;
}

}  // namespace gloam

#pragma once
// Contacts of a robot with what it is not.

#include <cmath>
#include <optional>

#include "metrics/builtin/robot_metric.h"

namespace gloam {

struct RobotContact {
  int own_body = 0, other_body = 0, other_geom = -1;
  double force = 0;         ///< magnitude [N]
  double normal_force = 0;  ///< along the normal, pressing [N]
  double steepness = 0;     ///< |z| of the unit normal: 1 = the surface is level
};

/// Empty: the contact is not the robot's, is with itself, with a flex, or carries no force.
inline std::optional<RobotContact> contact_of(const MetricRobot& robot, const mjModel& model,
                                              const ContactState& contact) {
  const int a = contact.geoms[0].id, b = contact.geoms[1].id;
  if (a < 0 || b < 0) return {};
  const int bodies[2] = {model.geom_bodyid[a], model.geom_bodyid[b]};
  const bool own[2] = {robot.own_bodies[static_cast<size_t>(bodies[0])] != 0,
                       robot.own_bodies[static_cast<size_t>(bodies[1])] != 0};
  if (own[0] == own[1]) return {};
  const Vec3 &f = contact.force, &n = contact.normal;
  RobotContact out;
  out.own_body = bodies[own[0] ? 0 : 1];
  out.other_body = bodies[own[0] ? 1 : 0];
  out.other_geom = own[0] ? b : a;
  out.force = std::hypot(f.x, f.y, f.z);
  out.normal_force = f.x * n.x + f.y * n.y + f.z * n.z;
  out.steepness = std::fabs(n.z);
  if (out.force <= 0) return {};
  return out;
}

}  // namespace gloam

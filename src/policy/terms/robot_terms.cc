// Terms of the robot's state: base and joints.

#include <algorithm>

#include "policy/policy_spec.h"
#include "policy/terms/terms.h"

namespace gloam {
namespace {

void base_lin_vel(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.robot->v_B, out.begin());
}
void base_ang_vel(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.robot->omega_B, out.begin());
}
void projected_gravity(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.robot->gravity_B, out.begin());
}
void joint_pos(const TermInputs& in, std::span<double> out) {
  for (size_t i = 0; i < out.size(); ++i) out[i] = in.robot->q[i] - in.spec->default_positions[i];
}
void joint_vel(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.robot->qd, out.begin());
}
void last_action(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.action, out.begin());
}
void previous_action(const TermInputs& in, std::span<double> out) {
  std::ranges::copy(in.previous_action, out.begin());
}

constexpr TermKind kRobotTerms[] = {
    {.name = "base_lin_vel",
     .aliases = "base_linear_velocity",
     .fixed = 3,
     .unit = "m/s",
     .doc = "velocity of the base's origin, base frame",
     .write = base_lin_vel,
     .needs_base = true},
    {.name = "base_ang_vel",
     .aliases = "base_angular_velocity",
     .fixed = 3,
     .unit = "rad/s",
     .doc = "angular velocity of the base, base frame",
     .write = base_ang_vel,
     .needs_base = true},
    {.name = "projected_gravity",
     .fixed = 3,
     .unit = "1",
     .doc = "direction of gravity, base frame; upright: (0, 0, -1)",
     .write = projected_gravity,
     .needs_base = true},
    {.name = "joint_pos",
     .aliases = "joint_pos_rel dof_pos",
     .per_joint = 1,
     .unit = "rad",
     .doc = "positions of the policy's joints less their default positions",
     .write = joint_pos},
    {.name = "joint_vel",
     .aliases = "joint_vel_rel dof_vel",
     .per_joint = 1,
     .unit = "rad/s",
     .doc = "velocities of the policy's joints",
     .write = joint_vel},
    {.name = "last_action",
     .aliases = "actions action last_actions",
     .per_joint = 1,
     .unit = "1",
     .doc = "the network's previous output, after its clip; 0 at first",
     .write = last_action},
    {.name = "previous_action",
     .per_joint = 1,
     .unit = "1",
     .doc = "the output before last_action; 0 at first",
     .write = previous_action},
};

}  // namespace

std::span<const TermKind> robot_terms() { return kRobotTerms; }

}  // namespace gloam

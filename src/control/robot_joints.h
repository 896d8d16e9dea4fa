#pragma once
// Actuators of a robot by the joints that they drive.

#include <mujoco/mujoco.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// An actuator that drives one hinge or slide of a robot.
struct DrivenJoint {
  std::string name;  ///< of the joint, without the robot's prefix; "" when it has none
  int joint = -1;
  int actuator = -1;
  int ctrl = -1;  ///< index of its control
  int qpos = -1, dof = -1;
  double inertia = 0;         ///< that one torque at the joint accelerates, in qpos0 [kg m² or kg]
  double gear = 1;            ///< joint torque per unit of actuator force
  bool takes_target = false;  ///< position servo: its control is the joint's angle times the gear
  bool takes_velocity = false;  ///< velocity servo: likewise the joint's velocity
  double gain = 1;              ///< actuator force per unit of control
  /// Terms of a servo's force that do not depend on the control: constant, per length, per velocity
  double bias[3] = {};
  double lowest, highest;              ///< limits of the control; ±infinity when it has none
  double force_lowest, force_highest;  ///< limits of the actuator's force; ±infinity when none
};

enum class VelocityServos : uint8_t { kLeaveOut, kInclude };

/// Name of a joint or actuator without its robot's prefix; "" when it has none.
std::string joint_name(const mjModel& model, int joint, const RobotInstance& robot);
std::string actuator_name(const mjModel& model, int actuator, const RobotInstance& robot);

/// Whether the robot's controller may use the actuator.
bool may_use(const RobotInstance& robot, int actuator);

/// Control with which a motor gives a torque at its joint [N m or N], within its limits.
double control_of_torque(const DrivenJoint& motor, double torque);
/// Control that moves a joint to `target` [rad or m] at `velocity` [rad/s or m/s]: the target
/// itself for a servo; for a motor the torque kp (target - q) + kd (velocity - v), in N m/rad and
/// N m s/rad. Within the actuator's limits.
double control_of_position(const DrivenJoint& joint, const mjData& data, double target,
                           double velocity, double kp, double kd);

/// An actuator of any transmission, without its joint. Nothing for one that is neither a motor nor
/// a servo, has activations, or has more than one control.
std::optional<DrivenJoint> actuator_terms(
    const mjModel& model, int actuator, VelocityServos velocity_servos = VelocityServos::kLeaveOut);

/// The joints of a fixed tendon; none of a spatial one.
std::vector<int> joints_of_tendon(const mjModel& model, int tendon);

/// In the order of the actuators. Actuators with another transmission, with activations, or with
/// more than one control are left out.
std::vector<DrivenJoint> driven_joints(const mjModel& model, const RobotInstance& robot,
                                       VelocityServos velocity_servos = VelocityServos::kLeaveOut);

}  // namespace gloam

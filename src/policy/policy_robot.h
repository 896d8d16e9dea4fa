#pragma once
// A robot in MuJoCo's memory as its policy reads and drives it, in the order of the policy's
// joints.

#include <mujoco/mujoco.h>

#include <span>
#include <string>
#include <vector>

#include "policy/policy_spec.h"

namespace gloam {

class PolicyRobot {
 public:
  /// Errors: all joints, actuators or sensors that the robot does not have; joints other than
  /// hinges or slides; no floating base if a term needs it; actuators whose torque is no immediate
  /// function of their control.
  static Result<PolicyRobot> create(const TermBinding& binding);

  /// Reads the present state.
  void measure(const mjData& data, RobotState* out) const;
  /// Reading of the sensor of a part, from the last step; empty: the part has no sensor.
  std::span<const double> reading(const mjData& data, const ObservationPart& part) const;

  /// Writes controls that give the torques kp (target - q) - kd v within the torque limits; targets
  /// (n) [rad]. Position servos of the policy's gains receive the targets.
  void drive(std::span<const double> targets, mjData* data) const;
  /// The same with the torques -kd v.
  void damp(mjData* data) const;

  bool is_servo() const { return is_servo_; }
  const std::vector<std::string>& joint_names() const { return joint_names_; }  ///< full names

 private:
  struct Joint {
    int qpos = -1, dof = -1, ctrl = -1;
    double gear = 1, gain = 1;
    double bias[3] = {};  ///< actuator force = gain * control + b0 + b1 * length + b2 * velocity
    double kp = 0, kd = 0, limit = 0;
  };
  struct Sensor {
    std::string name;
    int address = 0, size = 0;
  };
  Status find_joints(const TermBinding& binding);
  Status find_actuator(const TermBinding& binding, int joint, Joint* out) const;
  Status find_sensors(const TermBinding& binding);
  Status find_base(const TermBinding& binding);
  static void write_torque(const Joint& joint, double torque, mjData* data);
  bool takes_targets(const Joint& joint) const;

  std::vector<Joint> joints_;
  std::vector<std::string> joint_names_;
  std::vector<Sensor> sensors_;
  int base_qpos_ = -1, base_dof_ = -1;  // of the floating base; -1 = none
  bool is_servo_ = false;
};

}  // namespace gloam

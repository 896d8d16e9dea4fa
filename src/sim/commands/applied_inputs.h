#pragma once
// What Commands have put on the simulation and what stays until it is changed: controls, mocap
// poses, wrenches, dragged bodies. Called on the sim thread only; allocates nothing.

#include <mujoco/mujoco.h>

#include <vector>

#include "gloam/command.h"
#include "sim/joints/joint_inputs.h"
#include "sim/state/correspondence.h"

namespace gloam {

class AppliedInputs {
 public:
  explicit AppliedInputs(const CompiledWorld& world, const mjModel& model);

  /// Goes on where another World's left off, with what remains of it.
  void take_over(const AppliedInputs& before, const Correspondence& same);

  /// Forgets everything; the mjData has been reset by the caller.
  void reset();

  void apply(const mjModel& model, mjData& data, const SetControl& command);
  void apply(const mjModel& model, mjData& data, const SetControls& command);
  void apply(const mjModel& model, mjData& data, const SetJointState& command);
  void apply(const mjModel& model, mjData& data, const SetMocapPose& command);
  void apply(const mjModel& model, mjData& data, const SetWrench& command);
  void apply(const mjModel& model, mjData& data, const AddVelocity& command);
  void apply(const mjModel& model, mjData& data, const DragBody& command);
  void apply(const mjModel& model, mjData& data, const TurnBody& command);
  void apply(const mjModel& model, mjData& data, const SetEquality& command);
  void apply(const mjModel&, mjData&, const SetJointGoal& command) { joints_.apply(command); }
  void apply(const mjModel&, mjData&, const SetJointCommand& command) { joints_.apply(command); }
  void apply(const mjModel& model, mjData& data, const StopTrajectory& command) {
    joints_.stop(command, model, data);
  }

  JointInputs& joints() { return joints_; }
  const JointInputs& joints() const { return joints_; }

  /// Pulls and turns dragged bodies; call before every step. MuJoCo errors possible: call it
  /// guarded.
  void before_step(const mjModel& model, mjData& data);

 private:
  struct Drag {
    int body;
    double point_B[3], target_W[3];
    double
        mass;  // effective inertia at the point, the mean over directions [kg]; 0 = not yet known
  };
  struct Turn {
    int body;
    double target_WB[4];
    double inertia;  // effective, the mean over axes [kg m²]; 0 = not yet known
  };
  void pull(const mjModel& model, mjData& data, Drag& drag);
  void turn(const mjModel& model, mjData& data, Turn& turn);
  double mean_inertia(const mjModel& model, mjData& data);
  void set_base_wrench(mjData& data, int body) const;

  std::vector<std::vector<int>> controls_;  // indices of controls, by robot
  std::vector<double> wrench_;              // by SetWrench: force, torque [N, N m], (nbody x 6)
  std::vector<Drag> drags_;                 // at most one per body
  std::vector<Turn> turns_;                 // at most one per body
  std::vector<double> jacobian_, solved_;   // (3 x nv) each
  JointInputs joints_;
};

}  // namespace gloam

#pragma once
// Commands: the only way to change a running simulation. Each Command has the integer step at which
// it applies. If that step has passed, it applies at the next one; the log records the step at
// which it was applied.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gloam/joints/joint_command.h"
#include "gloam/result.h"
#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam {

/// Sets one actuator's control, in the actuator's own unit.
struct SetControl {
  Actuator actuator;
  double value = 0;
};
/// Sets the position or velocity of a joint, in the units of JointState.
struct SetJointState {
  Joint joint;
  std::vector<double> qpos, qvel;  ///< all of the joint's numbers; empty = unchanged
};
/// Sets all controls of a robot at once, in the order of RobotInfo::actuators, each in its
/// actuator's own unit.
struct SetControls {
  Robot robot;
  std::vector<double> values;
};
/// Velocity goal of the robot's controller, in its heading frame [m/s, m/s, rad/s, m/s].
struct SetVelocityGoal {
  Robot robot = {0, 0};
  double vx = 0, vy = 0, yaw_rate = 0;
  double vz = 0;  ///< up; of flying robots only
};
/// Goal pose of the frame that the robot's controller controls, in the world; stays until changed.
/// The controllers "ik" and "osc" use it instead of the pose that the frame has at the start.
struct SetPoseGoal {
  Robot robot = {0, 0};
  Pose X_WF;
};
/// Pose of a mocap body.
struct SetMocapPose {
  Body body;
  Pose X_WB;
};
/// Force and torque on a body at its centre of mass, world axes [N, N m]; stays until changed.
struct SetWrench {
  Body body;
  Vec3 force, torque;
};
/// Adds to the linear velocity of a free body (or of the root of a floating robot) [m/s].
struct AddVelocity {
  Body body;
  Vec3 velocity;
};
/// Pulls a point of a body towards a target like a spring (MuJoCo's perturbation), until `active`
/// is false.
struct DragBody {
  Body body;
  Vec3 point_B;
  Vec3 target_W;
  bool active = true;
};
/// Rotates a body towards an orientation like a spring (MuJoCo's perturbation), until `active` is
/// false.
struct TurnBody {
  Body body;
  Quat target_WB;
  bool active = true;
};
/// Switches an equality constraint on or off.
struct SetEquality {
  Equality equality;
  bool active = true;
};
/// Returns to the initial state; step and time restart at zero.
struct ResetSim {};

/// The model fields that may change while the simulation runs. Values have the same meaning as in
/// the model; images show them from the step at which the Command applies.
enum class LiveFieldId {
  kGravity,              ///< (3) [m/s²]
  kWind,                 ///< (3) [m/s]
  kBodyMass,             ///< (nbody) [kg]; the inertia scales with it
  kGeomFriction,         ///< (ngeom x 3)
  kHeightField,          ///< (nhfielddata) 0..1, for rendering and collisions
  kLightDiffuse,         ///< (nlight x 3)
  kLightIntensity,       ///< (nlight) [cd], 0 = use the diffuse colour only (docs/light.md)
  kLightActive,          ///< (nlight) 0 or 1
  kGeomColor,            ///< (ngeom x 4) rgba 0..1; 0.5 0.5 0.5 1 = colour of the material
  kMaterialColor,        ///< (nmat x 4) rgba 0..1
  kMaterialEmission,     ///< (nmat) >= 0
  kMaterialSpecular,     ///< (nmat) 0..1
  kMaterialShininess,    ///< (nmat) 0..1
  kMaterialReflectance,  ///< (nmat) 0..1, of planes and boxes
  kMaterialMetallic,     ///< (nmat) 0..1, -1 = not given
  kMaterialRoughness,    ///< (nmat) 0..1, -1 = not given: use shininess
  kActuatorGain,         ///< (nactuator x 10) gainprm
  kActuatorBias,         ///< (nactuator x 10) biasprm: [1] = -kp and [2] = -kv of a position servo
  kDofArmature,          ///< (nv) [kg or kg m²]
  kDofDamping,           ///< (nv) [N s/m or N m s/rad]
  kDofFrictionLoss,      ///< (nv) [N or N m]
  kJointStiffness,       ///< (njnt) [N/m or N m/rad]
};
inline constexpr int kLiveFieldCount = static_cast<int>(LiveFieldId::kJointStiffness) + 1;
const char* live_field_name(LiveFieldId field);  ///< "gravity", as in World::inputs()
/// Name of its array in MuJoCo, for Instant::value: "opt.gravity".
const char* live_field_array(LiveFieldId field);
/// Error: no such field; the hint suggests the nearest name.
Result<LiveFieldId> find_live_field(std::string_view name);

/// Replaces elements [first, first + values.size()) of a live field.
struct SetLiveField {
  LiveFieldId field = LiveFieldId::kGravity;
  int first = 0;
  std::vector<double> values;
};

/// When the simulation is recompiled, queued Commands apply to the elements of the same names.
/// Commands for elements that no longer exist are discarded.
struct Command {
  static constexpr int64_t kNextStep = -1;
  int64_t step = kNextStep;  ///< applies before this step
  std::variant<SetControl, SetVelocityGoal, SetMocapPose, SetWrench, AddVelocity, DragBody,
               ResetSim, SetLiveField, SetJointState, SetControls, SetJointGoal, SetJointCommand,
               SetController, FollowTrajectory, StopTrajectory, SetPoseGoal, TurnBody, SetEquality>
      what;
};

/// A Command and the time at which it was applied.
struct LoggedCommand {
  int64_t run = 0;  ///< number of resets before it
  Command command;  ///< `step` = the step at which it was applied; a ResetSim ends its run
};

}  // namespace gloam

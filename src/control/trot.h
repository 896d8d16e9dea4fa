#pragma once
// A trot for any 12-joint quadruped with torque motors: walks where a velocity goal says, by
// contact alone. Per control step: gait clock, foot placement (Raibert 1986, "Legged Robots That
// Balance"), swing feet by inverse dynamics, stance feet by distributing the wanted body
// acceleration over friction-limited ground forces (as in Focchi et al. 2017, "High-slope terrain
// locomotion for torque-controlled quadruped robots").
//
// The robot's own base pose and velocity, joints and foot contacts, with rigid ground or soil, are
// read as they are: state estimation is taken as perfect. Nothing about the world is read. Only
// motor torques are written, within the actuators' limits.

#include <memory>

#include "gloam/controller.h"
#include "gloam/drive/robot_goals.h"
#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

struct TrotOptions;

/// Status of a trot controller.
struct TrotStatus {
  bool fallen = false;    ///< tipped over or collapsed; the motors then only brake
  bool stepping = false;  ///< false = stands on four feet
  int64_t calls = 0;      ///< of control() since reset
  int64_t saturated = 0;  ///< how many motor commands had to be cut to the limit since reset
};

class TrotController : public Controller {
 public:
  virtual const TrotStatus& status() const = 0;
  bool fallen() const { return status().fallen; }
};

/// Finds the robot's legs, feet and motors. Errors: kUnsupported when it is not a 12-joint
/// quadruped with a torque motor on each joint.
Result<std::unique_ptr<Controller>> make_trot_controller(const CompiledWorld& world,
                                                         const RobotInstance& robot);
Result<RobotGoals> trot_goals(const CompiledWorld& world, const RobotInstance& robot);
/// The same with other numbers.
Result<std::unique_ptr<TrotController>> make_trot_controller(const mjModel& model,
                                                             const RobotInstance& robot,
                                                             const TrotOptions& options);

}  // namespace gloam

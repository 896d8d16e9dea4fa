#pragma once
// Posts the goals of one robot.

#include <memory>
#include <optional>
#include <string>

#include "gloam/drive/robot_goals.h"
#include "gloam/simulation.h"
#include "teleop/inputs.h"
#include "teleop/jog.h"

namespace gloam::teleop {

/// Goals in heading frames: velocities, or steps of the goal of a frame. Finds the robot by its
/// name after a recompile. Errors of all functions: the robot or what moves it no longer exists;
/// another client has claimed it; as for Simulation::post().
class RobotDriver {
 public:
  /// `robot`: "" = the first that can be driven. Errors: no such robot, with the nearest name; its
  /// controllers accept neither velocity nor pose goals.
  static Result<std::unique_ptr<RobotDriver>> create(Simulation& simulation,
                                                     const std::string& robot);

  const std::string& robot() const { return name_; }
  const RobotGoals& goals() const { return goals_; }
  bool moves_frame() const { return moves_frame_; }  ///< else it sets velocities
  int speed() const { return speed_; }
  void set_speed(int speed);

  /// Sets the velocity goal; of a frame, moves its goal by a stick's step since the last call.
  Status steer(const Deflection& move, Time now);
  /// Moves the goal of a frame by a key's step.
  Status jog(const Deflection& move, Time now);
  /// Stands still: velocity zero, or the frame's present pose.
  Status stop(Time now);
  /// Continues with the other kind of goal; false if there is only one.
  bool switch_goal(Time now);
  /// Closes the gripper if it is open, and vice versa.
  Status toggle_gripper(Time now) { return set_gripper(!is_open_, now); }
  Status set_gripper(bool open, Time now);
  /// Gives other clients the robot one second after the last goal other than zero.
  void release_idle(Time now);

  std::string goal_text() const;  ///< for display

 private:
  RobotDriver(Simulation& simulation, std::string name);
  Status look_up();
  Status post(const Command& command, Time now);
  Status post_velocity(const SetVelocityGoal& goal, Time now);
  Status move_goal(const Deflection& move, const JogStep& step, Time now);

  Simulation& simulation_;
  const std::string name_;
  std::shared_ptr<const CompiledWorld> world_;  // for which all handles are
  Robot robot_;
  Body root_;
  RobotGoals goals_;
  bool moves_frame_ = false, is_open_ = true;
  int speed_ = kUsualSpeed;
  std::unique_ptr<ControlLease> lease_;
  Time last_post_, last_steer_;
  int64_t last_step_ = 0;
  SetVelocityGoal velocity_;  // latest that was posted
  std::optional<Pose> X_WG_;  // likewise
  Instant instant_;
};

}  // namespace gloam::teleop

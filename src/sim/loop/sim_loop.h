#pragma once
// SimLoop: the order of things around every step, the same on whichever thread runs it:
//   Snapshots due now -> Commands due now -> controllers -> logged controllers, step hook ->
//   physics.

#include <functional>
#include <optional>
#include <vector>

#include "sim/commands/command_queue.h"
#include "sim/loop/next_world.h"
#include "sim/loop/run_ends.h"
#include "sim/loop/run_record.h"
#include "sim/snapshots/subscription.h"
#include "sim/state/correspondence.h"

namespace gloam {

/// Raw access before every step, after Commands and controllers. What it writes into mjData counts
/// as input: it is in state and hash. MuJoCo functions that can fail need try_mujoco.
using StepHook = std::function<void(const mjModel*, mjData*)>;

struct LoopState;

class SimLoop {
 public:
  /// `scene_commands` apply in every run, `replay` in the run each entry names; both sorted.
  SimLoop(std::unique_ptr<Stepper> stepper, Rational timestep, CommandQueue& commands,
          std::vector<Command> scene_commands, std::vector<LoggedCommand> replay,
          ControllerMaker make_controller = {});

  Status add_controller(int robot, std::unique_ptr<Controller> controller, Rational rate);
  /// The controller of a robot; null = it has none.
  const Controller* controller_of(int robot) const {
    return controllers_[static_cast<size_t>(robot)].now.controller.get();
  }
  /// The controller and the models of the actuators of a robot.
  Status add_robot(RobotController robot);
  /// Goes on in another World at the present step. `next` comes as it was made, with what belongs
  /// to its World; it gets back what was here before. Error: then nothing has changed.
  Status exchange(NextWorld& next, const Correspondence& same);
  void set_step_hook(StepHook hook) { hook_ = std::move(hook); }
  void keep_hook_inputs(std::shared_ptr<HookInputs> inputs) { hook_inputs_ = std::move(inputs); }
  Result<std::shared_ptr<SnapshotQueue>> subscribe(const SubscriptionOptions& options,
                                                   const std::shared_ptr<Signal>& signal);

  /// Hands out the Snapshots that are due at the present step. False when a required queue is full:
  /// call again when it may have room.
  bool publish_due();
  /// From now on queues of sensors are waited for as required ones are, or not.
  void set_waits_for_sensors(bool waits) { waits_for_sensors_ = waits; }
  /// Wakes the readers of what was handed out and waits to be a batch.
  void flush_queues();
  /// Applies Commands and takes one step; when a Command was a reset, stands at step 0 instead.
  /// False when physics failed.
  bool advance();
  /// Back to step 0; Commands that wait are thrown away.
  void reset();

  /// Worlds of the present run, and the instant at which it stands.
  const std::vector<RunRecord::Chapter>& chapters() const { return chapters_; }
  uint64_t run_seed() const { return run_seed_; }  ///< from which the run's hashes are chained
  int64_t first_step() const {
    return first_step_;
  }  ///< of the run; of a checkpoint, if it is one's
  /// Numbers that step hooks wrote before first_step().
  const std::vector<StepInput>& earlier_inputs() const { return earlier_inputs_; }
  /// Stepper::jump.
  void jump(int64_t step);
  /// A copy of the instant; null where effects or controllers cannot be copied.
  std::unique_ptr<LoopState> save() const;
  /// Goes on in a new run from an instant that was saved in the World that runs. Error: then only a
  /// reset goes on.
  Status restore(const LoopState& saved, const RunRecord& record);
  /// Goes on in a new run where `made` stands, which gets back what was here before.
  void adopt(SimLoop& made, const RunRecord& record);

  Stepper& stepper() { return *stepper_; }
  const Stepper& stepper() const { return *stepper_; }
  Rational timestep() const { return timestep_; }
  int64_t run() const { return run_; }
  const RunEnds& run_ends() const { return run_ends_; }
  /// Snapshots that best-effort subscriptions have lost.
  int64_t dropped() const;
  void close_queues();

 private:
  void apply(const Command& command, std::unique_ptr<PreparedInput>& prepared);
  void apply_unprepared(const Command& command);
  void switch_controller(ControllerSlot* next);
  void start_controller(ControllerSlot* slot, const Controller* before);
  void exchange_controllers(NextWorld* next, const Correspondence& same);
  bool take_step();
  bool apply_commands();
  /// Runs the controllers whose controls are inputs of a log, or all others.
  void run_controllers(bool logged);
  bool has_logged_controllers() const;
  void run_hook();
  void begin_run();
  void end_run(double time);
  void begin_run_at(const RunRecord& record);
  void take_over_goals(const Correspondence& same);
  void find_next_publication();
  VelocityTarget& goal_of(int robot) { return goals_[static_cast<size_t>(robot)]; }
  RobotControl& control_of(int robot) { return controllers_[static_cast<size_t>(robot)]; }

  std::unique_ptr<Stepper> stepper_;
  Rational timestep_;
  CommandQueue& commands_;
  std::vector<Command> scene_commands_;
  std::vector<LoggedCommand> replay_;
  size_t scene_cursor_ = 0, replay_cursor_ = 0;
  std::vector<VelocityTarget> goals_;            // by robot
  std::vector<std::optional<Pose>> pose_goals_;  // by robot
  ControllerMaker make_controller_;              // empty = Commands cannot switch them
  std::vector<RobotControl> controllers_;        // by robot
  std::vector<Subscription> subscriptions_;
  StepHook hook_;
  std::shared_ptr<HookInputs> hook_inputs_;  // null = not kept
  std::vector<RunRecord::Chapter> chapters_;
  uint64_t run_seed_ = 0;
  int64_t first_step_ = 0;
  std::vector<StepInput> earlier_inputs_;
  int64_t run_ = 0;
  RunEnds run_ends_;
  int64_t next_publication_ = 0;  // earliest `due` of the subscriptions
  int64_t dropped_by_closed_ = 0;
  bool waits_for_sensors_ = false;
};

}  // namespace gloam

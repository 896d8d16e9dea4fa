#pragma once
// A running simulation: physics on its own thread, Commands in, Snapshots out. Every function may
// be called from any thread; those that change the simulation take effect between two steps and
// return when they have. While the sim thread stands still, the calling thread does the work of
// short calls in its place, which saves two switches of thread (30 µs). On the sim thread itself
// (controllers, step hook) what is told at once (latest, status, counters, pause, set_pace) works,
// and what would wait for a step is an Error.

#include <array>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "gloam/simulation.h"
#include "sim/loop/checkpoint.h"
#include "sim/loop/motion.h"
#include "sim/loop/pacer.h"
#include "sim/loop/restepper.h"

namespace gloam {

struct SimulatorOptions {
  uint64_t seed = 1;                    ///< the chain of state hashes starts from it
  std::optional<double> timestep = {};  ///< instead of the model's, > 0 [s]
  Pace pace = Pace::kFast;
  double speed = 1;                         ///< for kRealTime and kSensors, > 0
  DataMaker make_data = {};                 ///< empty = the simulation makes its own mjData
  int command_capacity = 4096;              ///< Commands in flight between two steps, 2 … 2^20
  int64_t log_capacity = int64_t{1} << 20;  ///< Commands the log keeps until they are taken
  std::vector<LoggedCommand> replay = {};   ///< a log of the same world, applied at its exact steps
  RobotMakers makers = {};                  ///< for SetController; empty = an error
};

struct SimCounters {
  int64_t steps = 0;  ///< over all runs
  int64_t resets = 0;
  int64_t snapshots_dropped = 0;   ///< by best-effort subscriptions whose reader was too slow
  int64_t pool_grown = 0;          ///< Snapshots allocated because readers held too many
  int64_t commands_applied = 0;    ///< posted ones, resets among them
  int64_t commands_discarded = 0;  ///< that waited when a reset came, or a recompile without
                                   ///< their thing
  int64_t log_lost = 0;  ///< missing in the log: Commands, recompiles: a replay would not be exact
  int64_t deadlines_missed = 0;                ///< steps that began late in real-time mode
  int64_t most_contacts = 0;                   ///< in one step
  std::array<int64_t, mjNWARNING> warnings{};  ///< of MuJoCo, by mjtWarning
};

class Simulator {
 public:
  static constexpr int64_t kForever = std::numeric_limits<int64_t>::max();
  static constexpr int64_t kShortRun = 64;  ///< steps that step() may take on its caller's thread

  /// Stands at step 0; nothing moves before start().
  static Result<std::unique_ptr<Simulator>> create(std::shared_ptr<const CompiledWorld> world,
                                                   SimulatorOptions options = {});
  ~Simulator();  ///< stops

  /// Starts the thread, once. In kLockstep it then waits to be told; otherwise it runs to `until`.
  void start(int64_t until = kForever);
  /// Ends the thread and all subscriptions. Snapshots that were handed out stay good.
  void stop();
  void pause();
  /// The same, but returns before the step that is under way has ended, which may be never: a step
  /// hook is a user's function.
  void halt();
  void resume();
  /// Runs until `step` steps since reset, then waits. Returns at once.
  void run_until(int64_t step);
  /// Takes n steps and returns when they are done and their Snapshots published. A required queue
  /// that this thread reads must have room for them.
  Status step(int64_t n = 1);
  /// The same without waiting for other threads: takes up to kShortRun steps on this one, if the
  /// sim thread stands still. Nothing when the steps are the sim thread's, which has begun them:
  /// wait().
  std::optional<Status> begin_steps(int64_t n);
  /// Waits until it runs no longer: paused, told step reached, failed or stopped. The Error of a
  /// failure.
  Status wait();
  /// The same, but at most `time`, and without a call to the sim thread, which is not to be
  /// interrupted by those that look every few milliseconds. Whether it runs no longer.
  bool wait_for(std::chrono::milliseconds time);
  /// Back to step 0 now, also after a failure. Commands that wait are thrown away.
  Status reset();
  void set_pace(Pace pace, double speed);

  /// Before start(): `motion` tells where bodies are, instead of physics, controllers and Commands.
  /// It ends at `end`, where the simulation then stands still.
  Status follow(std::unique_ptr<Motion> motion, int64_t end = kForever);
  /// Goes to `step` of a motion in a new run, forwards or back, and stands there. Blocks: effects
  /// are solved from the beginning on.
  Status seek(int64_t step);
  int64_t end() const { return end_; }

  /// Checks a Command, makes what it needs on this thread, and queues it; waits for nothing but a
  /// recompile's moment. Errors: not a thing of this World, a controller or trajectory that cannot
  /// be made, queue full.
  Status post(Command command) { return post(std::span<const Command>(&command, 1)); }
  /// The same for several, which come to the simulation together: all or none.
  Status post(std::span<const Command> commands);
  /// Runs before steps at `rate`, of which the step rate is a multiple; reset now and at every
  /// reset.
  Status add_controller(int robot, std::unique_ptr<Controller> controller, Rational rate);
  /// The same for what a robot has of controller and models of its actuators.
  Status add_robot(RobotController robot);
  /// Calls `read` between two steps with the present controller of a robot, null = it has none.
  /// Error: a handle of another World.
  Status read_controller(Robot robot, const std::function<void(const Controller*)>& read);
  /// Error: called by a step hook or controller.
  Status set_step_hook(StepHook hook);
  /// From now on what the step hook writes is kept there; null = no longer.
  void keep_hook_inputs(std::shared_ptr<HookInputs> inputs);
  /// Where its runs lie in a time that goes on over resets; on all threads.
  const RunEnds& run_ends() const { return loop_.run_ends(); }
  /// Goes on in another World between two steps, with the state of what remains (state_transfer.h),
  /// the Commands that wait (Correspondence::translate), all subscriptions (their next Snapshots
  /// are of the new World; windows that have begun are lost) and these controllers. Error: then the
  /// old World runs on; another timestep, a simulation that has failed, what MuJoCo says.
  Status recompile(std::shared_ptr<const CompiledWorld> world,
                   std::vector<RobotController> controllers);
  /// The record of all that has led to the present instant, and a copy of it where that can be.
  /// Errors: the simulation has failed, Commands were not kept.
  Result<std::shared_ptr<const CheckpointData>> checkpoint();
  /// Goes on from there in a new run. What takes long is done before, while the simulation runs on.
  /// Commands that wait are thrown away. Errors: of another timestep; stepping it again ends
  /// elsewhere, which is what a step hook or an unpredictable controller does.
  Status restore(const CheckpointData& checkpoint);
  /// From the present step on. The reader holds what it got for as long as it likes.
  Result<std::shared_ptr<SnapshotQueue>> subscribe(const SubscriptionOptions& options);
  /// The present instant; after a failure the last good one.
  Snapshot latest();
  PhysicsMemory memory();

  /// kDiverged (or MuJoCo's own error) once physics has failed, until reset().
  Status status();
  SimCounters counters();
  /// Posted Commands that have applied since the last call, in order, with the step they applied
  /// at.
  std::vector<LoggedCommand> take_command_log() { return commands_.take_log(); }

  /// Whether the caller is a controller, a step hook or what they call.
  bool is_on_sim_thread() const {
    return sim_thread_.load(std::memory_order_relaxed) == std::this_thread::get_id();
  }
  /// Timestep instead of the model's, if there is one [s].
  std::optional<double> own_timestep() const { return own_timestep_; }
  int64_t step_count() const { return step_count_.load(std::memory_order_relaxed); }
  /// Exact as a fraction: a step takes num / den seconds.
  Rational timestep() const { return loop_.timestep(); }
  /// CPU time of the sim thread [s], without steps on callers' threads; 0 before start() and after
  /// stop().
  double cpu_time();
  std::shared_ptr<const CompiledWorld> world() const {
    const std::lock_guard lock(world_mutex_);
    return world_;
  }

 private:
  Simulator(std::unique_ptr<Stepper> stepper, Rational timestep, SimulatorOptions options,
            std::vector<Command> scene_commands);
  Status check_timestep(const CompiledWorld& world) const;

  /// The right to move the simulation: the sim thread has it but while it waits.
  class Turn;
  enum class Wake : uint8_t { kNo, kYes };  ///< kYes: the sim thread may have something to do now
  void call(const std::function<void()>& f, Wake wake = Wake::kYes);
  void look(const std::function<void()>& f) { call(f, Wake::kNo); }
  bool wake();  // false: it does not run
  static Error no_call_from_a_step();
  bool take_steps_here();
  bool is_idle();
  void run_thread();
  void answer_calls();
  bool report_idle();
  bool wants_step() const {
    return !paused_ && !halted_.load(std::memory_order_relaxed) && remaining_ > 0 &&
           loop_.stepper().step_count() < std::min(until_, end_);
  }
  void take_step();

  const uint64_t seed_;
  const std::optional<double> own_timestep_;  // [s]
  const DataMaker make_data_;
  const RobotMakers makers_;
  const bool replays_;  // a log
  Pace pace_;
  CommandQueue commands_;
  SimLoop loop_;
  RealTimePacer pacer_;

  std::mutex turn_mutex_;  // held by the Turn
  // Of the thread that has the Turn.
  bool paused_ = false, quit_ = false;
  int64_t until_ = 0, remaining_ = kForever, end_ = kForever;
  int64_t total_steps_ = 0;

  std::thread thread_;
  std::atomic<std::thread::id> sim_thread_{};  // that has the Turn
  std::shared_ptr<Signal> signal_ = std::make_shared<Signal>();
  std::atomic<bool> called_{false}, halted_{false};
  std::atomic<int64_t> step_count_{0};
  std::mutex recompile_mutex_;      // one at a time
  mutable std::mutex world_mutex_;  // guards world_; a Command is checked and queued under it
  std::shared_ptr<const CompiledWorld> world_;
  std::mutex join_mutex_;  // one thread at a time joins or asks for the handle
  std::mutex mutex_;       // guards what follows
  std::condition_variable changed_;
  std::vector<const std::function<void()>*> calls_;
  int64_t calls_made_ = 0, calls_answered_ = 0;
  bool running_ = false;  // the thread lives
  bool idle_ = true;
};

}  // namespace gloam

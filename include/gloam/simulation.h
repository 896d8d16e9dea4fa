#pragma once
// Simulation: a World that runs. Physics has its own thread; cameras render on theirs. Everything
// here may be called from any thread; callbacks say on which thread they come. On the physics
// thread itself (step hooks, controllers) what would wait for a step is an Error: step(),
// run_until(), recompile(), opening and closing streams.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/camera.h"
#include "gloam/camera_stream.h"
#include "gloam/checkpoint.h"
#include "gloam/command.h"
#include "gloam/control_lease.h"
#include "gloam/physics_memory.h"
#include "gloam/result.h"
#include "gloam/scene.h"
#include "gloam/sensor.h"
#include "gloam/simulation_options.h"
#include "gloam/snapshot.h"
#include "gloam/snapshot_stream.h"
#include "gloam/topics.h"
#include "gloam/world.h"

struct mjModel_;
struct mjData_;

namespace gloam {

class Simulation {
 public:
  static Result<std::unique_ptr<Simulation>> create(const World& world,
                                                    const SimulationOptions& options);
  virtual ~Simulation() = default;

  /// The one that runs; after a recompile another one.
  virtual World world() const = 0;
  /// Goes on in another World at the present step: a robot more, a box less, another mass. What has
  /// the same full name (without a name: the same place among its like) keeps its state: joints of
  /// the same type, activations, controls, mocap poses, external forces, drags, equalities, live
  /// fields that were changed, plugins; robots keep their goals and controllers. What is new begins
  /// as its scene says. Commands that wait are for the things of the same names; those whose thing
  /// is gone are dropped. Streams go on: an exposure or scan that has begun is lost; those whose
  /// camera, LiDAR or sensor is gone, or keeps another schedule, end and say so in status().
  /// Handles must be found again. Time, step and the chain of hashes go on; ResetSim goes to the
  /// initial state of the new World. The old World runs on while the new one is made, and after an
  /// Error: a scene that does not compile, another timestep, a simulation that has failed.
  virtual Status recompile(const World& world) = 0;
  Status recompile(const Scene& scene) {
    GLOAM_TRY(const World world, World::compile(scene));
    return recompile(world);
  }
  /// Steps until `step`, then pauses; blocks. Errors: diverged (the last good state is kept),
  /// stopped by request_stop().
  virtual Status run_until(int64_t step) = 0;
  /// Runs until paused; returns at once.
  virtual void resume() = 0;
  virtual void pause() = 0;
  virtual bool paused() const = 0;
  /// Takes n steps and pauses again; blocks. Short calls may run on the calling thread.
  virtual Status step(int64_t n) = 0;
  virtual void set_pace(Pace pace, double speed) = 0;
  /// Makes run_until and step return early with ErrorKind::kInterrupted. Safe in signal handlers.
  virtual void request_stop() = 0;
  /// How the physics is: ok, or why it stopped.
  virtual Status status() const = 0;

  /// Queues a Command. Errors: the queue is full, the handle is not of this World.
  virtual Status post(const Command& command) = 0;
  /// Queues all of them for the same moment, or none.
  virtual Status post(std::span<const Command> commands) = 0;
  /// The present instant, to be gone back to or branched from. Errors: the simulation has failed;
  /// more Commands than are kept (2^20 in a run).
  virtual Result<Checkpoint> checkpoint() = 0;
  /// Goes on from a checkpoint of this or another simulation of the same scene and timestep:
  /// Snapshots are of a new run, Commands that wait are thrown away, streams and claims stay.
  /// Blocks; where the checkpoint is not a copy, the run is stepped again while this one runs on.
  /// Error: it ended in another state (step hooks are not repeated); then nothing has changed.
  virtual Status restore(const Checkpoint& checkpoint) = 0;
  /// Makes the controls and goals of a robot this caller's alone until the lease is destroyed:
  /// SetControl, SetControls, SetVelocityGoal and SetJointGoal of others are an Error from then on.
  /// Error: it is claimed already.
  virtual Result<std::unique_ptr<ControlLease>> claim(Robot robot) = 0;
  /// Posted Commands that have applied since the last call, in order, with the step they applied
  /// at.
  virtual std::vector<LoggedCommand> take_command_log() = 0;
  virtual Snapshot latest() const = 0;
  virtual PhysicsMemory memory() = 0;
  virtual SimulationStats stats() const = 0;
  /// Called on the physics thread before every step, after Commands and controllers, with the
  /// private model and data: what it writes into mjData counts as input. Set before the first step.
  /// Error: called by a step hook or controller.
  virtual Status set_step_hook(std::function<void(const mjModel_*, mjData_*)> hook) = 0;

  /// Opens a stream; `on_frame` comes on the stream's own thread, frames in order.
  virtual Result<std::unique_ptr<CameraStream>> open_camera(const CameraRequest& request,
                                                            FrameCallback on_frame) = 0;
  /// Opens a stream of one of MuJoCo's sensors, with the model of the scene's [[sensor]] (without
  /// one: the truth, at every step). Errors: no such sensor, a rate above the step rate.
  virtual Result<std::unique_ptr<SensorStream>> open_sensor(const SensorRequest& request,
                                                            SensorCallback on_message) = 0;
  virtual std::vector<std::string> camera_names() const = 0;
  /// Opens the stream of a [[lidar]]; `on_scan` comes on the stream's own thread, scans in order.
  virtual Result<std::unique_ptr<LidarStream>> open_lidar(const LidarRequest& request,
                                                          ScanCallback on_scan) = 0;
  /// Opens a stream of Snapshots. Errors: a rate above the step rate, a capacity below 1.
  virtual Result<std::unique_ptr<SnapshotStream>> open_snapshots(const SnapshotRequest& request,
                                                                 SnapshotCallback on_snapshot) = 0;
  /// Topics of the World that runs. Error: a [[topic]] of the scene that fits none.
  virtual Result<std::vector<TopicInfo>> topics() const = 0;
  /// Opens topics as streams of encoded messages. What nobody opens is not computed. After a
  /// recompile, topics that are gone are silent. Errors: no such topic, one that is heard.
  virtual Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest& request,
                                                           TopicCallback on_message) = 0;
  /// Posts what a message to an input topic asks for; `data` is CDR. Errors: no such input, a
  /// damaged message, those of post().
  virtual Status publish(std::string_view topic, std::span<const uint8_t> data) = 0;
  /// The Commands that publish() would post, for the holder of a ControlLease. Errors: as there.
  virtual Result<std::vector<Command>> decode_input(std::string_view topic,
                                                    std::span<const uint8_t> data) const = 0;
  virtual Result<std::vector<LabelRow>> labels() = 0;
  /// What the ray through pixel (u, v) [px] of a frame hits in the latest Snapshot. Error: nothing
  /// there.
  virtual Result<PickResult> pick(const CameraFrame& frame, double u, double v) = 0;
  /// Pose X_WB of a body in the latest Snapshot. Error: no such body.
  virtual Result<Pose> body_pose(Body body) = 0;

  /// Physics steps per simulated second, exact.
  virtual Rational step_rate() const = 0;
};

}  // namespace gloam

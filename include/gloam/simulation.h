#pragma once
// Simulation: runs a World. Physics has its own thread; cameras render on others. All functions may
// be called from any thread; each callback documents its thread. On the physics thread itself (step
// hooks, controllers) functions that would wait for a step return an Error: step(), run_until(),
// recompile(), opening and closing streams.

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

  /// The World that runs; a recompile replaces it.
  virtual World world() const = 0;
  /// Continues in another World at the present step, for example with a robot added, a box removed
  /// or a mass changed. Elements with the same full name (unnamed ones: with the same index among
  /// elements of their kind) keep their state: joints of the same type, activations, controls,
  /// mocap poses, external forces, drags, equalities, changed live fields, plugins. Robots keep
  /// their goals and controllers. New elements start as their scene defines. Queued Commands apply
  /// to the elements of the same names, and are dropped if these no longer exist. Streams continue,
  /// but an exposure or scan in progress is lost. Streams whose camera, LiDAR or sensor is gone or
  /// has another schedule end and report this in status(). Handles must be looked up again. Time,
  /// step and the chain of hashes continue; ResetSim returns to the initial state of the new World.
  /// The old World keeps running while the new one is compiled, and after an Error: the scene does
  /// not compile, the timestep differs, the simulation has failed.
  virtual Status recompile(const World& world) = 0;
  Status recompile(const Scene& scene) {
    GLOAM_TRY(const World world, World::compile(scene));
    return recompile(world);
  }
  /// Steps until `step`, then pauses; blocks. Errors: diverged (keeps the last valid state),
  /// stopped by request_stop().
  virtual Status run_until(int64_t step) = 0;
  /// Runs until paused; returns immediately.
  virtual void resume() = 0;
  virtual void pause() = 0;
  virtual bool paused() const = 0;
  /// Takes n steps and pauses again; blocks. Short calls may run on the calling thread.
  virtual Status step(int64_t n) = 0;
  virtual void set_pace(Pace pace, double speed) = 0;
  /// Makes run_until and step return early with ErrorKind::kInterrupted. Safe in signal handlers.
  virtual void request_stop() = 0;
  /// Status of the physics: ok, or the reason why it stopped.
  virtual Status status() const = 0;

  /// Queues a Command. Errors: the queue is full, the handle belongs to another World.
  virtual Status post(const Command& command) = 0;
  /// Queues all Commands for the same moment, or none of them.
  virtual Status post(std::span<const Command> commands) = 0;
  /// Saves the present instant, to return to it or branch from it. Errors: the simulation has
  /// failed; more Commands than the limit of 2^20 in a run.
  virtual Result<Checkpoint> checkpoint() = 0;
  /// Continues from a checkpoint of this or another simulation of the same scene and timestep.
  /// Snapshots belong to a new run, queued Commands are discarded, streams and claims stay. Blocks.
  /// If the checkpoint is not a copy, its run is stepped again while the current one continues.
  /// Error: the repeated run reached another state (step hooks are not repeated); the simulation is
  /// then unchanged.
  virtual Status restore(const Checkpoint& checkpoint) = 0;
  /// Gives the caller exclusive control of a robot until the lease is destroyed: Commands
  /// for it, its joints or its actuators from others return an Error. Error: the robot is already
  /// claimed.
  virtual Result<std::unique_ptr<ControlLease>> claim(Robot robot) = 0;
  /// Commands that were applied since the last call, in order, with the step at which they were
  /// applied.
  virtual std::vector<LoggedCommand> take_command_log() = 0;
  virtual Snapshot latest() const = 0;
  virtual PhysicsMemory memory() = 0;
  virtual SimulationStats stats() const = 0;
  /// Sets a function that is called on the physics thread before every step, after Commands and
  /// controllers, with the simulation's own model and data. Values that it writes into mjData are
  /// inputs. Set it before the first step. Error: called by a step hook or controller.
  virtual Status set_step_hook(std::function<void(const mjModel_*, mjData_*)> hook) = 0;

  /// Opens a stream of a camera. `on_frame` is called on the stream's own thread, for frames in
  /// order.
  virtual Result<std::unique_ptr<CameraStream>> open_camera(const CameraRequest& request,
                                                            FrameCallback on_frame) = 0;
  /// Opens a stream of a MuJoCo sensor, with the sensor model of the scene's [[sensor]] or, without
  /// one, the true value at every step. Errors: no such sensor, a rate above the step rate.
  virtual Result<std::unique_ptr<SensorStream>> open_sensor(const SensorRequest& request,
                                                            SensorCallback on_message) = 0;
  virtual std::vector<std::string> camera_names() const = 0;
  /// Opens the stream of a [[lidar]]. `on_scan` is called on the stream's own thread, for scans in
  /// order.
  virtual Result<std::unique_ptr<LidarStream>> open_lidar(const LidarRequest& request,
                                                          ScanCallback on_scan) = 0;
  /// Opens a stream of Snapshots. Errors: a rate above the step rate, a capacity below 1.
  virtual Result<std::unique_ptr<SnapshotStream>> open_snapshots(const SnapshotRequest& request,
                                                                 SnapshotCallback on_snapshot) = 0;
  /// Topics of the World that runs. Error: a [[topic]] of the scene that matches none.
  virtual Result<std::vector<TopicInfo>> topics() const = 0;
  /// Opens topics as streams of encoded messages. Topics that are not open are not computed. Topics
  /// that no longer exist after a recompile send nothing. Errors: no such topic, an input topic.
  virtual Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest& request,
                                                           TopicCallback on_message) = 0;
  /// Subscribes to topics whose streams it shares with other sinks; it begins without topics. The
  /// subscription must end before the simulation, and `sink` must outlive it. Error: as topics().
  virtual Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink& sink) = 0;
  /// Posts the Commands of a message to an input topic; `data` is CDR. Errors: no such input, a
  /// malformed message; as for post().
  virtual Status publish(std::string_view topic, std::span<const uint8_t> data) = 0;
  /// Returns the Commands that publish() would post, for the holder of a ControlLease. Errors: as
  /// for publish().
  virtual Result<std::vector<Command>> decode_input(std::string_view topic,
                                                    std::span<const uint8_t> data) const = 0;
  virtual Result<std::vector<LabelRow>> labels() = 0;
  /// Finds the surface that the ray through pixel (u, v) [px] of a frame hits in the latest
  /// Snapshot. Error: the ray hits nothing.
  virtual Result<PickResult> pick(const CameraFrame& frame, double u, double v) = 0;
  /// Returns the pose X_WB of a body in the latest Snapshot. Error: no such body.
  virtual Result<Pose> body_pose(Body body) = 0;

  /// Physics steps per simulated second, exact.
  virtual Rational step_rate() const = 0;
};

}  // namespace gloam

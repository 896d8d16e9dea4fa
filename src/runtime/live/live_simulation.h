#pragma once
// gloam::Simulation over the simulation core, the shared renderer and the cameras.

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "gloam/simulation.h"
#include "runtime/live/input_log.h"
#include "runtime/live/robot_claims.h"
#include "runtime/streams/exposure_meter.h"
#include "runtime/streams/latched_topics.h"
#include "runtime/streams/live_camera.h"
#include "runtime/streams/live_lidar.h"
#include "runtime/streams/live_sensors.h"
#include "runtime/streams/live_snapshots.h"
#include "runtime/streams/topic_tables.h"
#include "topics/hub/topic_hub.h"

namespace gloam {

class TopicFeed;

/// Choice whether automatic exposures go on while nobody opens their cameras, which takes
/// rendering.
enum class Metering : uint8_t { kAlways, kNever };

struct LiveOptions {
  Metering metering = Metering::kAlways;
  std::unique_ptr<Motion> motion = nullptr;  ///< instead of physics
  int64_t end = Simulator::kForever;         ///< step at which the motion ends
  size_t commands = 0;  ///< that are posted before the first step, beyond the usual number
};

class LiveSimulation final : public Simulation {
 public:
  static Result<std::unique_ptr<LiveSimulation>> create(const World& world,
                                                        const SimulationOptions& options,
                                                        LiveOptions live = {});
  World world() const override { return World(simulator_->world()); }
  Status recompile(const World& world) override;
  using Simulation::recompile;
  Status run_until(int64_t step) override;
  void resume() override;
  void pause() override;
  bool paused() const override { return paused_; }
  Status step(int64_t n) override;
  void set_pace(Pace pace, double speed) override;
  void request_stop() override { stop_requested_ = true; }
  Status status() const override { return simulator_->status(); }
  Status post(const Command& command) override;
  Status post(std::span<const Command> commands) override;
  Result<Checkpoint> checkpoint() override;
  Status restore(const Checkpoint& checkpoint) override;
  Result<std::unique_ptr<ControlLease>> claim(Robot robot) override;
  std::vector<LoggedCommand> take_command_log() override { return simulator_->take_command_log(); }
  Snapshot latest() const override { return simulator_->latest(); }
  PhysicsMemory memory() override { return simulator_->memory(); }
  SimulationStats stats() const override;
  Status set_step_hook(std::function<void(const mjModel_*, mjData_*)> hook) override;
  Result<std::unique_ptr<CameraStream>> open_camera(const CameraRequest& request,
                                                    FrameCallback on_frame) override;
  Result<std::unique_ptr<SensorStream>> open_sensor(const SensorRequest& request,
                                                    SensorCallback on_message) override;
  Result<std::unique_ptr<LidarStream>> open_lidar(const LidarRequest& request,
                                                  ScanCallback on_scan) override;
  Result<std::unique_ptr<SnapshotStream>> open_snapshots(const SnapshotRequest& request,
                                                         SnapshotCallback on_snapshot) override;
  Result<std::vector<TopicInfo>> topics() const override;
  Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest& request,
                                                   TopicCallback on_message) override;
  Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink& sink) override;
  Status publish(std::string_view topic, std::span<const uint8_t> data) override;
  Result<std::vector<Command>> decode_input(std::string_view topic,
                                            std::span<const uint8_t> data) const override;
  std::vector<std::string> camera_names() const override;
  Result<std::vector<LabelRow>> labels() override;
  Result<Pose> body_pose(Body body) override;
  Result<PickResult> pick(const CameraFrame& frame, double u, double v) override;
  Rational step_rate() const override;

  // For the runtime's own jobs.
  uint64_t seed() const { return seed_; }
  Result<std::shared_ptr<const TopicTable>> topic_table() const {
    return topics_.of(simulator_->world());
  }
  Result<std::shared_ptr<const TopicTable>> topic_table_of(
      const std::shared_ptr<const CompiledWorld>& world) const {
    return topics_.of(world);
  }
  /// From now on messages of inputs are kept there, for a log; null = no longer.
  void keep_received_inputs(std::shared_ptr<ReceivedInputs> inputs) {
    const std::lock_guard lock(received_mutex_);
    received_ = std::move(inputs);
  }
  Simulator& simulator() { return *simulator_; }
  /// The same as open_topics() for a reader in no hurry: SubscriptionOptions::batch.
  Result<std::unique_ptr<TopicFeed>> open_topic_batches(const TopicRequest& request, int batch,
                                                        TopicCallback on_message);
  Result<std::shared_ptr<SharedRenderer>> renderer() { return renderers_.of(simulator_->world()); }
  Result<std::unique_ptr<LiveCamera>> open_live_camera(const CameraRequest& request,
                                                       FrameCallback on_frame);
  /// Sends them again when another World runs.
  void add_latched(std::weak_ptr<LatchedTopics> topics);
  /// Several sensors in one stream.
  Result<std::unique_ptr<LiveSensors>> open_live_sensors(LiveSensorsRequest request,
                                                         SensorCallback on_message);
  /// All sensors of the model in one stream.
  Result<std::unique_ptr<LiveSensors>> open_all_sensors(bool required, SensorCallback on_message);
  /// Parts for its streams, which end before it.
  StreamContext stream_context() { return {*simulator_, renderers_, costs_, seed_}; }
  std::vector<SensorCost> sensor_costs() const { return costs_.list(); }
  const ExposureMeters& meters() const { return meters_; }
  /// Sources of its probes' readings; valid while it lives.
  ProbeSources probe_sources();
  Result<std::unique_ptr<LiveLidar>> open_live_lidar(const LidarRequest& request,
                                                     ScanCallback on_scan);

 private:
  LiveSimulation(const SimulationOptions& options, Metering metering)
      : seed_(options.seed),
        metering_(metering),
        keep_waiting_(options.keep_waiting),
        meters_(options.pace != Pace::kRealTime) {}
  void restart_speed_clock();
  bool has_to_stop(int look);
  Status stopped_by_the_user();
  void forget_other_worlds();
  bool repeats_a_reset();
  void send_latched();
  using Solve = Status (PoseSolver::*)(const Snapshot&, PoseFrame&);
  Result<std::shared_ptr<const CompiledWorld>> solve_latest(Solve solve, PoseFrame& poses);

  const uint64_t seed_;
  const Metering metering_;
  const std::function<bool()> keep_waiting_;
  std::unique_ptr<Simulator> simulator_;
  SharedRenderers renderers_;
  SensorCosts costs_;
  std::mutex recompile_mutex_;  // one at a time
  ExposureMeters meters_;
  RobotClaims claims_;
  mutable TopicTables topics_;
  mutable std::mutex received_mutex_;
  std::shared_ptr<ReceivedInputs> received_;
  std::mutex latched_mutex_;
  std::vector<std::weak_ptr<LatchedTopics>> latched_;
  std::mutex solver_mutex_;
  std::unique_ptr<PoseSolver> solver_;  // for questions about the latest instant
  std::atomic<bool> paused_{true}, stop_requested_{false};
  mutable std::mutex clock_mutex_;
  double clock_wall_ = 0;    // time from which the real-time factor counts [s]
  int64_t clock_steps_ = 0;  // steps taken by then
  double last_reset_ = -1;   // [s]
  std::atomic<Pace> pace_{Pace::kFast};
  std::mutex hub_mutex_;
  std::unique_ptr<TopicHub> hub_;  // last: its streams use the others; null until it is needed
};

}  // namespace gloam

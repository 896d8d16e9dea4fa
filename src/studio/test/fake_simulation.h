#pragma once
// A made-up simulation for tests and for looking at the page: balls that circle over a chequered
// floor, drawn by a few lines of ray casting. It writes down what was asked of it.

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gloam/simulation.h"

namespace gloam {

class FakeSimulation : public Simulation {
 public:
  FakeSimulation();
  ~FakeSimulation() override;

  World world() const override { return world_; }
  Status run_until(int64_t step) override;
  void resume() override;
  void pause() override;
  bool paused() const override;
  Status step(int64_t n) override;
  void set_pace(Pace pace, double speed) override;
  void request_stop() override {}
  Status status() const override;
  using Simulation::recompile;
  Status recompile(const World&) override { return unsupported(); }
  Status post(const Command& command) override;
  Status post(std::span<const Command> commands) override {
    for (const Command& command : commands) GLOAM_TRY_STATUS(post(command));
    return {};
  }
  std::vector<LoggedCommand> take_command_log() override { return {}; }
  Snapshot latest() const override { return {}; }
  PhysicsMemory memory() override { return {}; }
  SimulationStats stats() const override;
  Status set_step_hook(std::function<void(const mjModel_*, mjData_*)>) override { return {}; }
  Result<std::unique_ptr<CameraStream>> open_camera(const CameraRequest& request,
                                                    FrameCallback on_frame) override;
  Result<std::unique_ptr<SensorStream>> open_sensor(const SensorRequest&, SensorCallback) override {
    return unsupported();
  }
  Result<std::unique_ptr<LidarStream>> open_lidar(const LidarRequest&, ScanCallback) override {
    return unsupported();
  }
  Result<std::unique_ptr<SnapshotStream>> open_snapshots(const SnapshotRequest&,
                                                         SnapshotCallback) override {
    return unsupported();
  }
  Result<Checkpoint> checkpoint() override { return unsupported(); }
  Status restore(const Checkpoint&) override { return unsupported(); }
  Result<std::unique_ptr<ControlLease>> claim(Robot) override { return unsupported(); }
  Result<std::vector<TopicInfo>> topics() const override { return unsupported(); }
  Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest&, TopicCallback) override {
    return unsupported();
  }
  Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink&) override {
    return unsupported();
  }
  Status publish(std::string_view, std::span<const uint8_t>) override { return unsupported(); }
  Result<std::vector<Command>> decode_input(std::string_view,
                                            std::span<const uint8_t>) const override {
    return Error{ErrorKind::kInput, "no topics here"};
  }
  std::vector<std::string> camera_names() const override { return {"front", "robot/head"}; }
  Result<std::vector<LabelRow>> labels() override { return std::vector<LabelRow>{}; }
  Result<PickResult> pick(const CameraFrame& frame, double u, double v) override;
  Result<Pose> body_pose(Body body) override;
  Rational step_rate() const override { return {500, 1}; }

  // For tests.
  std::vector<std::string> calls() const;  ///< "pause", "resume", "step", "speed 0.5", "reset" …
  std::vector<DragBody> drags() const;
  int open_streams() const { return open_streams_; }
  void fail(Error error);                  ///< from now on status() and step() give this
  std::atomic<int> step_milliseconds = 0;  ///< how long a step takes

 private:
  static Error unsupported() {
    return {ErrorKind::kUnsupported, "the made-up simulation has pictures alone"};
  }

  class Stream;
  struct Ball {
    Vec3 center;
    double radius = 0;
    Vec3 color;
    std::string name;
  };

  void run();
  void note(std::string call);
  std::vector<Ball> balls() const;
  void draw(CameraFrame& frame) const;

  World world_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  double steps_ = 0;
  double speed_ = 1;
  bool running_ = false, stopping_ = false;
  Vec3 pulled_;  // how far the first ball has been dragged from its circle [m]
  std::vector<std::string> calls_;
  std::vector<DragBody> drags_;
  Status status_;
  std::atomic<int> open_streams_ = 0;
  std::thread thread_;
};

}  // namespace gloam

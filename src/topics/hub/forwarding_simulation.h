#pragma once
// ForwardingSimulation: forwards all calls to another Simulation; a decorator overrides the
// functions that it changes. One that changes open_topics() has a TopicHub of its own as its last
// member, so that subscriptions see the change.

#include <utility>

#include "gloam/simulation.h"

namespace gloam {

class ForwardingSimulation : public Simulation {
 public:
  /// `real` must outlive it.
  explicit ForwardingSimulation(Simulation& real) : real_(real) {}

  Result<std::unique_ptr<TopicStream>> open_topics(const TopicRequest& request,
                                                   TopicCallback on_message) override {
    return real_.open_topics(request, std::move(on_message));
  }
  Result<std::unique_ptr<TopicSubscription>> subscribe(TopicSink& sink) override {
    return real_.subscribe(sink);
  }
  World world() const override { return real_.world(); }
  Status recompile(const World& world) override { return real_.recompile(world); }
  Status run_until(int64_t step) override { return real_.run_until(step); }
  void resume() override { real_.resume(); }
  void pause() override { real_.pause(); }
  bool paused() const override { return real_.paused(); }
  Status step(int64_t n) override { return real_.step(n); }
  void set_pace(Pace pace, double speed) override { real_.set_pace(pace, speed); }
  void request_stop() override { real_.request_stop(); }
  Status status() const override { return real_.status(); }
  Status post(const Command& command) override { return real_.post(command); }
  Status post(std::span<const Command> commands) override { return real_.post(commands); }
  Result<Checkpoint> checkpoint() override { return real_.checkpoint(); }
  Status restore(const Checkpoint& checkpoint) override { return real_.restore(checkpoint); }
  Result<std::unique_ptr<ControlLease>> claim(Robot robot) override { return real_.claim(robot); }
  std::vector<LoggedCommand> take_command_log() override { return real_.take_command_log(); }
  Snapshot latest() const override { return real_.latest(); }
  PhysicsMemory memory() override { return real_.memory(); }
  SimulationStats stats() const override { return real_.stats(); }
  Status set_step_hook(std::function<void(const mjModel_*, mjData_*)> hook) override {
    return real_.set_step_hook(std::move(hook));
  }
  Result<std::unique_ptr<CameraStream>> open_camera(const CameraRequest& request,
                                                    FrameCallback on_frame) override {
    return real_.open_camera(request, std::move(on_frame));
  }
  Result<std::unique_ptr<SensorStream>> open_sensor(const SensorRequest& request,
                                                    SensorCallback on_message) override {
    return real_.open_sensor(request, std::move(on_message));
  }
  std::vector<std::string> camera_names() const override { return real_.camera_names(); }
  Result<std::unique_ptr<LidarStream>> open_lidar(const LidarRequest& request,
                                                  ScanCallback on_scan) override {
    return real_.open_lidar(request, std::move(on_scan));
  }
  Result<std::unique_ptr<SnapshotStream>> open_snapshots(const SnapshotRequest& request,
                                                         SnapshotCallback on_snapshot) override {
    return real_.open_snapshots(request, std::move(on_snapshot));
  }
  Result<std::vector<TopicInfo>> topics() const override { return real_.topics(); }
  Status publish(std::string_view topic, std::span<const uint8_t> data) override {
    return real_.publish(topic, data);
  }
  Result<std::vector<Command>> decode_input(std::string_view topic,
                                            std::span<const uint8_t> data) const override {
    return real_.decode_input(topic, data);
  }
  Result<std::vector<LabelRow>> labels() override { return real_.labels(); }
  Result<PickResult> pick(const CameraFrame& frame, double u, double v) override {
    return real_.pick(frame, u, v);
  }
  Result<Pose> body_pose(Body body) override { return real_.body_pose(body); }
  Rational step_rate() const override { return real_.step_rate(); }

 private:
  Simulation& real_;
};

}  // namespace gloam

#pragma once
// A camera of a running simulation: a thread that turns Snapshots into frames.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "gloam/simulation.h"
#include "runtime/rendering/shared_renderer.h"
#include "runtime/streams/exposure_meter.h"
#include "runtime/streams/stream_context.h"
#include "runtime/streams/stream_thread.h"
#include "sensors/camera/camera_sensor.h"
#include "sensors/timing.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {

class LiveCamera final : public CameraStream {
 public:
  static Result<std::unique_ptr<LiveCamera>> open(const StreamContext& context,
                                                  const CameraRequest& request,
                                                  FrameCallback on_frame,
                                                  const ExposureMeters& meters);
  /// A picture that nothing waits for is given up: it may take many seconds.
  ~LiveCamera() override {
    if (!request_.required) thread_.abandon();
  }
  void set_pose(const Pose& X_WC) override;
  Pose pose() const override;
  void refresh() override;
  void show(const Snapshot& snapshot) override;
  /// Other outputs from the next picture on, by their names; exposure and schedule go on. Outputs
  /// that need another schedule end the stream. Any thread.
  void set_outputs(std::vector<std::string> outputs);
  /// Whether the frame that is being delivered has an output. On its thread.
  bool has_made(const std::string& output) const;
  int64_t dropped() const override { return thread_.dropped(); }
  int64_t complete_at(int64_t from) const override { return thread_.complete_at(from); }
  void flush() override { thread_.flush(); }
  Status status() const override { return thread_.status(); }
  /// Waits until the simulation has stopped and every frame was delivered.
  void drain() { thread_.drain(); }
  /// The same, for at most `time`. Whether it has ended.
  bool drain_for(std::chrono::milliseconds time) { return thread_.drain_for(time); }
  /// Gives up the picture that is being made and those that wait: no frame is delivered any more.
  void abandon() { thread_.abandon(); }
  /// Pictures made, with the part of the next one, and whether no more are due yet.
  double pictures_made() const {
    return static_cast<double>(thread_.taken()) + part_.load(std::memory_order_relaxed);
  }
  bool is_idle() const { return thread_.is_idle(); }
  Rational rate() const { return request_.rate; }

 private:
  LiveCamera(const StreamContext& context, const CameraRequest& request, FrameCallback on_frame,
             const ExposureMeters& meters);
  Status follow(const std::shared_ptr<const CompiledWorld>& world);
  SnapshotWindow next_window();
  Snapshot take_shown();
  bool take_outputs();
  Status take(const SnapshotWindow& window);
  Status capture(const SnapshotWindow& window);

  Simulator& simulator_;
  SharedRenderers& renderers_;
  CameraRequest request_;  // with the outputs of the present sensor
  const uint64_t seed_;
  FrameCallback on_frame_;
  const ExposureMeters& meters_;
  std::shared_ptr<SharedRenderer> shared_;  // renderer of the World whose Snapshots come
  std::unique_ptr<CameraSensor> sensor_;
  std::optional<EventLead> lead_;  // lead of a required stream with events, until its thread ends
  SensorTiming timing_;
  std::shared_ptr<ExposureMeter> meter_;  // null: the exposure is the camera's own
  std::unique_ptr<PoseSolver> solver_;
  std::shared_ptr<SnapshotQueue> queue_;
  std::shared_ptr<SensorAccount> account_;
  std::vector<PoseFrame> keys_;  ///< poses of the window that is exposed
  PoseFrame previous_;           ///< the first of the window before
  bool has_previous_ = false;
  bool previous_is_still_ = false;  ///< it was an instant by itself, not a window
  mutable std::mutex mutex_;        // guards sensor_ against set_pose() and pose(), and wishes
  std::optional<std::vector<std::string>> wanted_outputs_;  // instead of the present ones
  Snapshot shown_;  // to be rendered at the next refresh; empty = the latest
  std::atomic<bool> refresh_wanted_{false};
  std::atomic<double> part_{0};  // of the picture that is being made, 0 … 1
  StreamThread thread_;          // last: it uses the others
};

}  // namespace gloam

#pragma once
// A camera of a running simulation: a thread that turns Snapshots into frames.

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "gloam/simulation.h"
#include "runtime/exposure_meter.h"
#include "runtime/shared_renderer.h"
#include "sensors/camera/camera_sensor.h"
#include "sensors/timing.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {

class LiveCamera final : public CameraStream {
 public:
  static Result<std::unique_ptr<LiveCamera>> open(Simulator& simulator, SharedRenderers& renderers,
                                                  const CameraRequest& request, uint64_t seed,
                                                  FrameCallback on_frame,
                                                  const ExposureMeters& meters);
  ~LiveCamera() override;

  void set_pose(const Pose& X_WC) override;
  Pose pose() const override;
  void refresh() override;
  int64_t dropped() const override { return queue_->dropped(); }

  /// Waits until the queue has ended (the simulation stopped) and every frame was delivered.
  void drain();
  Status status() const override;

 private:
  LiveCamera(Simulator& simulator, SharedRenderers& renderers, const CameraRequest& request,
             uint64_t seed, FrameCallback on_frame, const ExposureMeters& meters);
  Status follow(const std::shared_ptr<const CompiledWorld>& world);
  void run();
  void end(Error why);
  SnapshotWindow wait_for_work();
  void capture(const SnapshotWindow& window);

  Simulator& simulator_;
  SharedRenderers& renderers_;
  const CameraRequest request_;
  const uint64_t seed_;
  FrameCallback on_frame_;
  const ExposureMeters& meters_;
  std::shared_ptr<SharedRenderer> shared_;  // renderer of the World whose Snapshots come
  std::unique_ptr<CameraSensor> sensor_;
  std::optional<EventLead> lead_;  // lead of a required stream with events, until run() ends
  SensorTiming timing_;
  std::shared_ptr<ExposureMeter> meter_;  // null: the exposure is the camera's own
  std::unique_ptr<PoseSolver> solver_;
  std::shared_ptr<SnapshotQueue> queue_;
  std::vector<PoseFrame> keys_;  ///< poses of the window that is exposed
  PoseFrame previous_;           ///< the first of the window before
  bool has_previous_ = false;
  bool previous_is_still_ = false;  ///< it was an instant by itself, not a window
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Status status_;
  bool refresh_wanted_ = false, closing_ = false;
  std::thread thread_;
};

}  // namespace gloam

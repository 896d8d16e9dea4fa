#pragma once
// The automatic exposure of one camera, which goes on whether or not anyone opens the camera: a
// thread that meters a small picture of its own at each instant of the camera's schedule.

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "runtime/shared_renderer.h"
#include "sensors/camera_sensor.h"
#include "sensors/imager/exposure.h"
#include "sensors/timing.h"
#include "sim/pose_solver.h"
#include "sim/simulator.h"

namespace gloam {

class ExposureMeter {
 public:
  /// Of a [[camera]] with an auto_exposure. `required`: the simulation waits for it, so that the
  /// exposure is the same in every run.
  static Result<std::unique_ptr<ExposureMeter>> open(Simulator& simulator,
                                                     std::shared_ptr<SharedRenderer> shared,
                                                     const CameraOptions& camera, int max_depth,
                                                     uint64_t seed, bool required);
  ~ExposureMeter();

  /// Exposure value of a picture taken at `step`, a step that the simulation has come to; waits for
  /// its metering. Where that instant was lost, or the simulation has ended, the last one known.
  double ev100_at(int64_t step);

 private:
  ExposureMeter(std::shared_ptr<SharedRenderer> shared, const AutoExposureOptions& options)
      : shared_(std::move(shared)), options_(options), automatic_(options) {}
  void run();

  std::shared_ptr<SharedRenderer> shared_;
  const AutoExposureOptions options_;
  AutoExposure automatic_;
  bool required_ = false;
  std::unique_ptr<CameraSensor> probe_;
  std::unique_ptr<PoseSolver> solver_;
  SensorTiming timing_;
  std::shared_ptr<SnapshotQueue> queue_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int64_t, double> values_;  // the last ones, by step
  double newest_ = 0;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace gloam

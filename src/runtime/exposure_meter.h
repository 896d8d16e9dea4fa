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
                                                     SharedRenderers& renderers,
                                                     const CameraOptions& camera, uint64_t seed,
                                                     bool required);
  ~ExposureMeter();

  /// Exposure value of a picture taken at `step`, a step that the simulation has come to; waits for
  /// its metering. Where that instant was lost, or the simulation has ended, the last one known.
  double ev100_at(int64_t step);
  /// No more values come: the simulation has stopped, or a recompile took the camera away.
  bool ended();

 private:
  ExposureMeter(Simulator& simulator, SharedRenderers& renderers, const CameraOptions& camera,
                uint64_t seed)
      : simulator_(simulator),
        renderers_(renderers),
        camera_(camera.name),
        seed_(seed),
        options_(*camera.sensing.imager->auto_exposure),
        automatic_(options_) {}
  Status follow(const std::shared_ptr<const CompiledWorld>& world);
  void run();

  Simulator& simulator_;
  SharedRenderers& renderers_;
  const std::string camera_;
  const uint64_t seed_;
  std::shared_ptr<SharedRenderer> shared_;  // of the World whose Snapshots come
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

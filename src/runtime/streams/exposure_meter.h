#pragma once
// The automatic exposure of one camera, which goes on whether or not anyone opens the camera: a
// thread that meters a small picture of its own at each instant of the camera's schedule.

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "runtime/rendering/shared_renderer.h"
#include "runtime/streams/stream_context.h"
#include "runtime/streams/stream_thread.h"
#include "sensors/camera/camera_sensor.h"
#include "sensors/imager/exposure.h"
#include "sensors/timing.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {

class ExposureMeter {
 public:
  /// Opens the meter of a [[camera]] with an auto_exposure. `required`: the simulation waits for
  /// it, so that the exposure is the same in every run.
  static Result<std::unique_ptr<ExposureMeter>> open(const StreamContext& context,
                                                     const CameraOptions& camera, bool required);

  /// Exposure value of a picture taken at `step`, a step that the simulation has come to, by the
  /// last metering before it, as a camera meters one frame and exposes the next: waits for that.
  /// The first picture is exposed by its own light. Where that instant was lost, the last one known
  /// before it; where none is, the first one known.
  double ev100_at(int64_t step);
  /// Has the camera an automatic exposure in `world`, at the same instants? In another World the
  /// meter ends.
  bool goes_on_in(const CompiledWorld& world) const;

 private:
  ExposureMeter(const StreamContext& context, const CameraOptions& camera,
                const SensorTiming& timing, bool required)
      : simulator_(context.simulator),
        renderers_(context.renderers),
        camera_(camera.name),
        seed_(context.seed),
        timing_(timing),
        required_(required),
        automatic_(*camera.sensing.imager->auto_exposure) {}
  Status follow(const std::shared_ptr<const CompiledWorld>& world);
  Status take(const Snapshot& snapshot);
  Status meter(const Snapshot& snapshot);
  void release_world();
  // The last step of the schedule that is not after `step`, or its first.
  int64_t instant_of(int64_t step) const;

  Simulator& simulator_;
  SharedRenderers& renderers_;
  const std::string camera_;
  const uint64_t seed_;
  const SensorTiming timing_;
  const bool required_;
  std::shared_ptr<SharedRenderer> shared_;  // renderer of the World whose Snapshots come
  AutoExposure automatic_;
  std::unique_ptr<CameraSensor> probe_;
  std::shared_ptr<SensorAccount> account_;
  std::unique_ptr<PoseSolver> solver_;
  PoseFrame poses_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int64_t, double> values_;  // the last ones, by step
  double newest_ = 0;
  bool ended_ = false;
  StreamThread thread_;  // last: it uses the others
};

/// The meters of a simulation. Any thread.
class ExposureMeters {
 public:
  explicit ExposureMeters(bool required) : required_(required) {}
  /// Opens those of the World that runs; what goes on in it stays open.
  Status open(const StreamContext& context);
  /// Meter of a camera in `world`, which may be an earlier one whose pictures are still being made;
  /// null where it has none, or is not open yet.
  std::shared_ptr<ExposureMeter> of(const std::string& camera, const CompiledWorld& world) const;

 private:
  using ByCamera = std::map<std::string, std::shared_ptr<ExposureMeter>>;
  struct OfWorld {
    std::weak_ptr<const CompiledWorld> world;
    ByCamera meters;
  };

  const bool required_;
  mutable std::mutex mutex_;
  std::vector<OfWorld> worlds_;  // that still exist; the one that runs is the last
};

}  // namespace gloam

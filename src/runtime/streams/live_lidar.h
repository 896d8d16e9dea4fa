#pragma once
// A LiDAR of a running simulation: a thread that gathers the instants of each scan and turns them
// into points.

#include <memory>
#include <vector>

#include "gloam/sensor.h"
#include "runtime/rendering/shared_renderer.h"
#include "runtime/streams/stream_context.h"
#include "runtime/streams/stream_thread.h"
#include "sensors/lidar/lidar_sensor.h"
#include "sim/loop/simulator.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {

class LiveLidar final : public LidarStream {
 public:
  /// Errors: no such LiDAR, numbers that do not go together, a rate above the step rate.
  static Result<std::unique_ptr<LiveLidar>> open(const StreamContext& context,
                                                 const LidarRequest& request, ScanCallback on_scan);
  /// Snapshots that were lost; a scan that lacks one is not made.
  int64_t dropped() const override { return thread_.dropped(); }
  /// Waits until the queue has ended (the simulation stopped) and every scan was delivered.
  void drain() { thread_.drain(); }
  /// Delivers nothing more, what waits included.
  void abandon() { thread_.abandon(); }
  Status status() const override { return thread_.status(); }
  int64_t complete_at(int64_t from) const override;
  void flush() override { thread_.flush(); }

 private:
  LiveLidar(const StreamContext& context, const LidarRequest& request, ScanCallback on_scan);
  Status follow(const std::shared_ptr<const CompiledWorld>& world);
  Status take(const Snapshot& snapshot);

  Simulator& simulator_;
  SharedRenderers& renderers_;
  const LidarRequest request_;
  const uint64_t seed_;
  ScanCallback on_scan_;
  std::shared_ptr<SharedRenderer> shared_;  // renderer of the World whose Snapshots come
  std::unique_ptr<LidarSensor> sensor_;
  std::shared_ptr<SensorAccount> account_;
  std::unique_ptr<PoseSolver> solver_;
  Rational key_rate_ = {1, 1};   // [Hz]
  StepSchedule schedule_;        // schedule of the keys; the same in every World that it follows
  int stretches_ = 1;            // stretches of a scan, between its keys
  std::vector<PoseFrame> keys_;  // poses of the scan that is being gathered
  int64_t next_key_ = 0;         // number of the key that is expected
  size_t gathered_ = 0;          // number of keys_ gathered
  StreamThread thread_;          // last: it uses the others
};

/// The [[lidar]] of a name. Error: there is none.
Result<LidarDescription> find_lidar(const CompiledWorld& world, const std::string& name);

/// Number of even stretches that a scan is cut into: at least `wanted` where that is possible, and
/// such that the instants between them are steps of the simulation where that is possible.
int motion_stretches(Rational rate, Rational timestep, int wanted);

}  // namespace gloam

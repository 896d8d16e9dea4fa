#pragma once
// Images and scans of given Snapshots, without a running simulation: of a replay, of an edited
// state, with another appearance.

#include <memory>
#include <span>
#include <vector>

#include "gloam/camera_stream.h"
#include "gloam/result.h"
#include "gloam/sensor.h"
#include "gloam/snapshot.h"
#include "gloam/world.h"

namespace gloam {

/// Renders Snapshots of one World. Use it from one thread at a time; several renderers may share a
/// World.
class SceneRenderer {
 public:
  /// Loads all data for rendering. Errors: files that cannot be read, no memory.
  static Result<SceneRenderer> create(const World& world);
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;
  ~SceneRenderer();

  /// Renders an image whose exposure begins at the first Snapshot and ends at the last one; with
  /// one Snapshot, an instant without motion blur. Motion is relative to the Snapshot previously
  /// rendered for this camera. `request.rate` and `request.required` are ignored. The pixels equal
  /// the output of an open stream with the same request, for the same instants, frame number and
  /// seed. Errors: no such camera or output, a Snapshot of another World, no Snapshot, the output
  /// events.
  Result<std::shared_ptr<const CameraFrame>> render(std::span<const Snapshot> exposure,
                                                    const CameraRequest& request,
                                                    int64_t frame_index = 0);
  /// Computes one scan of a [[lidar]] from the first Snapshot to the last one, evenly spaced: 2 or
  /// more.
  Result<std::shared_ptr<const LidarScan>> scan(std::span<const Snapshot> sweep,
                                                const LidarRequest& request,
                                                int64_t scan_index = 0);

 private:
  struct State;
  explicit SceneRenderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gloam

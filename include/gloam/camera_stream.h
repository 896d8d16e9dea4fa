#pragma once
// Streams of images from a running simulation.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gloam/camera.h"
#include "gloam/scene.h"
#include "gloam/snapshot.h"
#include "gloam/stream.h"

namespace gloam {

/// One stream of images from one camera.
struct CameraRequest {
  std::string camera = "free";  ///< full name, or "free": frames the whole model until moved
  /// Frames per second of simulation time; 0 = the camera's own rate, or 20 if it has none.
  Rational rate = {0, 1};
  int width = 0, height = 0;  ///< [px]; 0 = the camera's own
  /// Channels by name, from kCameraChannels (gloam/outputs.h).
  std::vector<std::string> outputs = {"rgb"};
  RenderOptions render = {};
  std::optional<Pose> X_WC = {};  ///< initial pose of camera "free"
  bool required = false;  ///< true: the simulation waits for this camera; false: frames may be
                          ///< dropped, oldest first
  bool is_view = false;   ///< for a viewer; Pace::kSensors does not wait for it
  EndCallback on_end = {};
};

class CameraStream : public Stream {
 public:
  /// Sets the pose of the free camera in the world; it looks along -Z. No effect on the model's own
  /// cameras.
  virtual void set_pose(const Pose& X_WC) = 0;
  virtual Pose pose() const = 0;
  /// Renders the latest Snapshot again, also while the simulation is paused.
  virtual void refresh() = 0;
  /// Renders this Snapshot of the World that runs instead, once.
  virtual void show(const Snapshot& snapshot) = 0;
};
using FrameCallback = std::function<void(std::shared_ptr<const CameraFrame>)>;

}  // namespace gloam

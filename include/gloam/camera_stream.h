#pragma once
// Streams of pictures of a running simulation.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gloam/camera.h"
#include "gloam/scene.h"
#include "gloam/stream.h"

namespace gloam {

/// One stream of pictures from one camera.
struct CameraRequest {
  std::string camera = "free";  ///< full name, or "free": frames the whole model until moved
  /// Frames per second of simulation time; 0 = the camera's own, else 20.
  Rational rate = {0, 1};
  int width = 0, height = 0;  ///< [px]; 0 = the camera's own
  /// Channels by name, from kCameraChannels (gloam/outputs.h).
  std::vector<std::string> outputs = {"rgb"};
  RenderOptions render = {};
  std::optional<Pose> X_WC = {};  ///< of camera "free": where it stands at first
  bool required =
      false;  ///< the simulation waits for this camera; else frames are dropped, oldest first
  bool is_view = false;  ///< a picture for a viewer, for which Pace::kSensors does not wait
  EndCallback on_end = {};
};

class CameraStream : public Stream {
 public:
  /// Moves the free camera: pose of the camera in the world, looks along -Z. No effect on the
  /// model's own cameras.
  virtual void set_pose(const Pose& X_WC) = 0;
  virtual Pose pose() const = 0;
  /// Renders the latest Snapshot again, also while the simulation is paused.
  virtual void refresh() = 0;
};
using FrameCallback = std::function<void(std::shared_ptr<const CameraFrame>)>;

}  // namespace gloam

#pragma once
// Cameras of a scene: places, lenses and shutters. Part of gloam/scene.h; docs/cameras.md has
// examples.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/sensor.h"
#include "gloam/types.h"

namespace gloam {

/// camera.lens: how directions become pixels, in the terms of ROS's CameraInfo, or in millimetres.
/// Pixels are those of the camera's own width and height, and their centres lie at integer + 0.5:
/// cx and cy are 0.5 more than in files of OpenCV and ROS.
struct LensOptions {
  /// pinhole | plumb_bob | rational_polynomial | equidistant (fisheye) | equirectangular
  std::string model = "pinhole";
  /// plumb_bob: k1 k2 p1 p2 [k3], rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6, equidistant: k1 k2
  /// k3 k4; missing ones are 0.
  std::vector<double> d = {};
  /// Focal lengths [px], equirectangular: [px/rad]. Empty: fy = fx; both by `fovy`, of a panorama
  /// so that the picture holds all directions.
  std::optional<double> fx = {}, fy = {};
  std::optional<double> cx = {}, cy = {};   ///< principal point [px]; empty = the middle
  std::optional<double> focal_length = {};  ///< [m], > 0; with sensor_size instead of fx, fy
  std::optional<std::array<double, 2>> sensor_size = {};  ///< width, height [m], > 0
  /// Focal length by the diameter of the opening: what is not at focus_distance is blurred (path
  /// tier). Needs focal_length. Empty = everything is sharp.
  std::optional<double> f_number = {};
  std::optional<double> focus_distance = {};  ///< from the lens's centre [m], > 0
  SourceLoc loc = {};
};

/// [[camera]]: a camera added to the scene, fixed in the world or on a body.
struct CameraOptions {
  std::string name = {};  ///< unique
  std::string body = {};  ///< full name of the body it sits on; empty = world
  /// Body whose position it follows with a fixed offset and heading; empty = none.
  std::string track = {};
  Vec3 position = {};  ///< in the frame of `body`; for `track`: offset from it in world axes [m]
  std::optional<Vec3> look_at = {};  ///< point to look at, in the same frame [m]
  /// Instead of look_at: looks along its -Z, up is +Y (MuJoCo's convention).
  std::optional<Quat> orientation = {};
  double fovy = 45;               ///< vertical field of view [deg], (0, 180)
  int width = 640, height = 480;  ///< [px], 1 … 16384
  Rational rate = {20, 1};        ///< frames per second of simulation time
  std::optional<LensOptions> lens = {};
  /// Time that each row sees light [s], >= 0: moving things are blurred. 0 = an instant.
  double exposure_time = 0;
  /// From the first row's exposure to the last one's [s], >= 0: above 0 a rolling shutter.
  double readout_time = 0;
  /// Those of kCameraOutputs (gloam/outputs.h) that are recorded, instead of what [record] says; []
  /// = its poses alone.
  std::optional<std::vector<std::string>> outputs = {};
  double near = 0;  ///< nothing nearer than this plane is seen [m], >= 0
  /// Bodies that it does not see, each with all that hangs on it: full names, * stands for any
  /// text. Their shadows and reflections are seen.
  std::vector<std::string> hide = {};
  CameraSensing sensing = {};  ///< imager, timing …: what happens between light and message
  SourceLoc loc = {};
};

}  // namespace gloam

#pragma once
// Cameras of a scene: poses, lenses and shutters. Part of gloam/scene.h; docs/cameras.md has
// examples.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gloam/result.h"
#include "gloam/scene/sensor.h"
#include "gloam/types.h"

namespace gloam {

/// camera.lens: mapping from directions to pixels, with the parameters of ROS's CameraInfo or in
/// millimetres. Pixels refer to the camera's own width and height. Their centres are at integer +
/// 0.5, so cx and cy are 0.5 more than in files of OpenCV and ROS.
struct LensOptions {
  /// pinhole | plumb_bob | rational_polynomial | equidistant (fisheye) | equirectangular
  std::string model = "pinhole";
  /// plumb_bob: k1 k2 p1 p2 [k3], rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6, equidistant: k1 k2
  /// k3 k4; missing ones are 0.
  std::vector<double> d = {};
  /// Focal lengths [px], equirectangular: [px/rad]. Empty: fy = fx; if both are empty they follow
  /// from `fovy`, or for a panorama are such that the image contains all directions.
  std::optional<double> fx = {}, fy = {};
  std::optional<double> cx = {}, cy = {};   ///< principal point [px]; empty = the image centre
  std::optional<double> focal_length = {};  ///< [m], > 0; with sensor_size instead of fx, fy
  std::optional<std::array<double, 2>> sensor_size = {};  ///< width, height [m], > 0
  /// Focal length divided by the diameter of the aperture: objects away from focus_distance are
  /// blurred (path tier). Needs focal_length. Empty = everything is sharp.
  std::optional<double> f_number = {};
  std::optional<double> focus_distance = {};  ///< from the centre of the lens [m], > 0
  SourceLoc loc = {};
};

/// [[camera]]: a camera added to the scene, fixed to the world or to a body.
struct CameraOptions {
  std::string name = {};  ///< unique
  std::string body = {};  ///< full name of the body or site to which it is fixed; empty = world
  /// Body whose position it follows with a fixed offset and heading; empty = none.
  std::string track = {};
  Vec3 position = {};  ///< in the frame of `body`; for `track`: offset from it in world axes [m]
  std::optional<Vec3> look_at = {};  ///< point to look at, in the same frame [m]
  /// Instead of look_at: the camera looks along its -Z, up is +Y (MuJoCo's convention).
  std::optional<Quat> orientation = {};
  double fovy = 45;               ///< vertical field of view [deg], (0, 180)
  int width = 640, height = 480;  ///< [px], 1 … 16384
  Rational rate = {20, 1};        ///< frames per second of simulation time
  std::optional<LensOptions> lens = {};
  /// Exposure time of each row [s], >= 0: moving objects are blurred. 0 = an instant.
  double exposure_time = 0;
  /// Time from the first row's exposure to the last row's [s], >= 0; above 0: a rolling shutter.
  double readout_time = 0;
  /// Recorded outputs, from kCameraOutputs (gloam/outputs.h), instead of the outputs in [record];
  /// [] = only its poses.
  std::optional<std::vector<std::string>> outputs = {};
  double near = 0;  ///< near clipping plane [m], >= 0: nothing nearer is visible
  /// Bodies that are invisible to the camera, each with all its descendants: full names, * matches
  /// any text. Their shadows and reflections remain visible.
  std::vector<std::string> hide = {};
  CameraSensing sensing = {};  ///< imager, timing …: stages between light and message
  SourceLoc loc = {};
};

}  // namespace gloam

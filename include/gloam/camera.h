#pragma once
// Messages of cameras: one per frame, with all channels from the same instant and the same rays.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/sensor.h"
#include "gloam/types.h"

namespace gloam {

/// Mapping of a lens from directions to pixels (docs/cameras.md), with the names of ROS if it has
/// one.
enum class LensModel : uint8_t {
  kPinhole,
  kPlumbBob,            ///< Brown–Conrady: k1 k2 p1 p2 k3
  kRationalPolynomial,  ///< k1 k2 p1 p2 k3 k4 k5 k6
  kEquidistant,         ///< Kannala–Brandt fisheye: k1 k2 k3 k4
  kEquirectangular,     ///< longitude to the right, latitude up; fx, fy are px per radian
};

/// Geometry of a camera's image. Pixel centres are at integer + 0.5; u to the right, v down.
struct Intrinsics {
  int width = 640, height = 480;  ///< [px]
  double fx = 0, fy = 0;          ///< focal lengths [px]
  double cx = 0, cy = 0;          ///< principal point [px] from the top left corner of the image
  bool orthographic = false;      ///< fx, fy are in px per metre, and there is no other lens
  LensModel lens = LensModel::kPinhole;
  std::array<double, 8> distortion = {};  ///< in the order above; others are 0
};

/// Ray through a point of the image, in the camera's frame C, which looks along -Z with +Y up.
struct PixelRay {
  Vec3 p_C;  ///< origin; differs from 0 in orthographic cameras only [m]
  Vec3 d_C;  ///< unit
  /// Ratio of CameraFrame::depth to the distance along the ray.
  double depth_share = 1;

  /// The point at a distance along the ray [m].
  Vec3 at(double distance) const {
    return {p_C.x + distance * d_C.x, p_C.y + distance * d_C.y, p_C.z + distance * d_C.z};
  }
  Vec3 at_depth(double depth) const { return at(depth / depth_share); }
};
/// Returns the ray through the point (u, v) [px], for every lens; none if the lens images nothing
/// there.
std::optional<PixelRay> pixel_ray(const Intrinsics& intrinsics, double u, double v);

/// Number of pixels and the edges of the rectangle around them [px]; u1, v1 are the far edges of
/// the last pixels. No pixels: u1 < u0.
struct PixelBox {
  int64_t pixels = 0;
  int u0 = 1 << 30, v0 = 1 << 30, u1 = -1, v1 = -1;
};

/// One object in an image. Its frame O is the frame of its first rendered body: the root of a
/// robot, or the world for elements fixed to it.
struct ObjectView {
  uint32_t instance = 0;  ///< as in LabelRow
  std::string name;
  uint32_t semantic = 0;
  PixelBox seen;  ///< pixels with the object at their centre
  PixelBox all;   ///< pixels that would show it without occlusion, within the image
  Pose X_WO;
  Vec3 center, size;     ///< box along O's axes that contains all its visible parts [m]
  bool endless = false;  ///< contains an infinite plane, so it has no box in space
  /// Fraction of it that is not hidden by others, 0 … 1.
  double visibility() const {
    return static_cast<double>(seen.pixels) / static_cast<double>(all.pixels);
  }
};

/// One frame of one camera. Channels that were not requested are empty vectors.
struct CameraFrame {
  std::string camera;  ///< full name
  int64_t index = 0;   ///< frame number since reset
  int64_t step = 0;    ///< physics step of the exposure
  double time = 0;     ///< [s] simulation time at which the first row's exposure starts
  bool warmup = false;
  Intrinsics intrinsics;
  double delivery = 0;  ///< [s] simulation time at which it reaches readers, >= time
  double ev100 = 0;     ///< exposure value of `rgb` and `raw`
  Pose X_WC;  ///< pose of the camera at `time`; looks along -Z, +Y up (MuJoCo's convention)
  double exposure_time = 0;  ///< exposure time of each row [s]
  double readout_time = 0;   ///< from the first row's exposure to the last one's [s]

  std::vector<uint8_t> rgb;     ///< tone-mapped sRGB, (height x width x 3)
  std::vector<float> radiance;  ///< linear Rec. 709 [cd/m²], (height x width x 3)
  // The following channels are exact: computed from the ray through each pixel's centre, at the
  // start of the exposure of its row.
  std::vector<float> depth;  ///< along the optical axis, for fisheyes and panoramas along the ray
                             ///< [m], +inf = nothing hit, (height x width)
  std::vector<float> distance;  ///< along the ray [m], +inf = nothing hit, (height x width)
  /// Row of the label table (one per rendered geom), 0 = nothing, (height x width).
  std::vector<uint32_t> part;
  uint32_t part_count = 0;         ///< rows of the label table, the maximum of these ids
  std::vector<uint32_t> instance;  ///< object id of the label table, 0 = nothing, (height x width)
  std::vector<uint32_t> semantic;  ///< class id of the label table, 0 = nothing, (height x width)
  std::vector<float> normal;       ///< unit, world axes, 0 = nothing, (height x width x 3)
  std::vector<float> albedo;       ///< (height x width x 3), 0..1
  std::vector<uint32_t> samples;   ///< number of light paths averaged in a pixel, (height x width)
  std::vector<float> motion;  ///< optical flow from the previous frame of this camera to this one
                              ///< [px], (height x width x 2)
  /// Numbers of the imager [DN]: (height x width) with a mosaic, otherwise (height x width x 3).
  std::vector<uint16_t> raw;
  /// Depth along the optical axis as measured by the camera's stereo_depth model [m], 0 = nothing,
  /// (height x width). `depth` is the ground truth.
  std::vector<float> sensor_depth;
  std::vector<Event> events;        ///< since the previous frame, in order of time
  std::vector<float> thermal;       ///< apparent temperature [K], (height x width)
  std::vector<float> scene_flow;    ///< displacement of the visible point since the previous frame
                                    ///< [m], world axes, (height x width x 3)
  std::vector<ObjectView> objects;  ///< objects in the image, including hidden ones, ordered by id
};

/// Content of ROS's sensor_msgs/CameraInfo. Its pixel centres are at integers, so the principal
/// point is 0.5 less than in Intrinsics.
struct CameraInfo {
  std::string frame_id;  ///< "NAME_optical_frame": Z forward, X right, Y down
  int width = 0, height = 0;
  std::string
      distortion_model;  ///< name in ROS, or "equirectangular" or "orthographic", which ROS lacks
  std::vector<double> d;
  std::array<double, 9> k = {};   ///< row-major
  std::array<double, 9> r = {};   ///< row-major; the identity: images are not rectified
  std::array<double, 12> p = {};  ///< row-major
};
CameraInfo camera_info(const std::string& camera, const Intrinsics& intrinsics);
/// Pose in the world of a camera's optical frame.
Pose optical_pose(const Pose& X_WC);

/// One rendered geom: `part` indexes this table.
struct LabelRow {
  uint32_t part = 0;
  std::string geom, body, material;  ///< full names; "" if unnamed
  /// Id of its object (robot, or body whose parent is the world).
  uint32_t instance = 0;
  std::string instance_name;
  uint32_t semantic = 0;
  std::string semantic_name;  ///< class: name of the robot or object without trailing digits;
                              ///< "floor", "wall" …
};

}  // namespace gloam

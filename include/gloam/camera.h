#pragma once
// Messages of cameras: one per frame, every channel of the same instant and the same rays.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gloam/sensor.h"
#include "gloam/types.h"

namespace gloam {

/// Mapping of a lens from directions to the picture (docs/cameras.md); names of ROS where it has
/// one.
enum class LensModel : uint8_t {
  kPinhole,
  kPlumbBob,            ///< Brown–Conrady: k1 k2 p1 p2 k3
  kRationalPolynomial,  ///< k1 k2 p1 p2 k3 k4 k5 k6
  kEquidistant,         ///< Kannala–Brandt fisheye: k1 k2 k3 k4
  kEquirectangular,     ///< longitude to the right, latitude up; fx, fy are px per radian
};

/// A camera's picture in pixels. Pixel centres lie at integer + 0.5; u to the right, v down.
struct Intrinsics {
  int width = 640, height = 480;  ///< [px]
  double fx = 0, fy = 0;          ///< focal lengths [px]
  double cx = 0, cy = 0;          ///< principal point [px] from the top left corner of the picture
  bool orthographic = false;      ///< then fx, fy are px per metre and there is no other lens
  LensModel lens = LensModel::kPinhole;
  std::array<double, 8> distortion = {};  ///< in the order above; the rest is 0
};

/// Ray through a point of the picture, in the camera's frame C, which looks along -Z with +Y up.
struct PixelRay {
  Vec3 p_C;  ///< origin; differs from 0 in orthographic cameras only [m]
  Vec3 d_C;  ///< unit
  /// CameraFrame::depth of what is seen over its distance along the ray.
  double depth_share = 1;

  /// The point at a distance along the ray [m].
  Vec3 at(double distance) const {
    return {p_C.x + distance * d_C.x, p_C.y + distance * d_C.y, p_C.z + distance * d_C.z};
  }
  Vec3 at_depth(double depth) const { return at(depth / depth_share); }
};
/// Ray through the point (u, v) [px], for every lens; none where the lens sees nothing.
std::optional<PixelRay> pixel_ray(const Intrinsics& intrinsics, double u, double v);

/// Pixels, and the edges of the rectangle around them [px]; u1, v1 are those of the last ones' far
/// sides. No pixels: u1 < u0.
struct PixelBox {
  int64_t pixels = 0;
  int u0 = 1 << 30, v0 = 1 << 30, u1 = -1, v1 = -1;
};

/// One object in a picture. Its frame O is that of its first body that is drawn: the root of a
/// robot, the world for what is fixed to it.
struct ObjectView {
  uint32_t instance = 0;  ///< as in LabelRow
  std::string name;
  uint32_t semantic = 0;
  PixelBox seen;  ///< pixels whose centre shows it
  PixelBox all;   ///< pixels that would show it if nothing stood in front of it, within the picture
  Pose X_WO;
  Vec3 center, size;     ///< box along O's axes that holds all visible parts of it [m]
  bool endless = false;  ///< an infinite plane is part of it: it has no box in space
  /// Share of it that is not hidden by others, 0 … 1.
  double visibility() const {
    return static_cast<double>(seen.pixels) / static_cast<double>(all.pixels);
  }
};

/// One frame of one camera. Empty vectors are channels that were not asked for.
struct CameraFrame {
  std::string camera;  ///< full name
  int64_t index = 0;   ///< frame number since reset
  int64_t step = 0;    ///< physics step of the exposure
  double time = 0;     ///< [s] simulation time at which the first row's exposure starts
  bool warmup = false;
  Intrinsics intrinsics;
  double delivery = 0;  ///< [s] simulation time at which it reaches a reader, >= time
  double ev100 = 0;     ///< exposure value of `rgb` and `raw`
  Pose X_WC;  ///< pose of the camera at `time`; looks along -Z, +Y up (MuJoCo's convention)
  double exposure_time = 0;  ///< exposure time of each row [s]
  double readout_time = 0;   ///< from the first row's exposure to the last one's [s]

  std::vector<uint8_t> rgb;     ///< tone-mapped sRGB, (height x width x 3)
  std::vector<float> radiance;  ///< linear Rec. 709 [cd/m²], (height x width x 3)
  // Exact channels from here on: taken from the ray through each pixel's centre, when its row's
  // exposure starts.
  std::vector<float> depth;     ///< along the optical axis, of fisheyes and panoramas along the ray
                                ///< [m], +inf = nothing hit, (height x width)
  std::vector<float> distance;  ///< along the ray [m], +inf = nothing hit, (height x width)
  /// Row of the label table (one per drawn geom), 0 = nothing, (height x width).
  std::vector<uint32_t> part;
  uint32_t part_count = 0;  ///< rows of the label table: the most that any of these ids may be
  std::vector<uint32_t> instance;  ///< object id of the label table, 0 = nothing, (height x width)
  std::vector<uint32_t> semantic;  ///< class id of the label table, 0 = nothing, (height x width)
  std::vector<float> normal;       ///< unit, world axes, 0 = nothing, (height x width x 3)
  std::vector<float> albedo;       ///< (height x width x 3), 0..1
  std::vector<uint32_t> samples;   ///< light paths in the mean of a pixel, (height x width)
  std::vector<float> motion;  ///< optical flow from the previous frame of this camera to this one
                              ///< [px], (height x width x 2)
  /// Numbers of the imager [DN]: behind a mosaic (height x width), else (height x width x 3).
  std::vector<uint16_t> raw;
  /// Depth along the optical axis as the camera's stereo_depth model measures it [m], 0 = nothing,
  /// (height x width). `depth` is the truth.
  std::vector<float> sensor_depth;
  std::vector<Event> events;        ///< since the frame before, in order of time
  std::vector<float> thermal;       ///< apparent temperature [K], (height x width)
  std::vector<float> scene_flow;    ///< way of the point that is seen since the previous frame [m],
                                    ///< world axes, (height x width x 3)
  std::vector<ObjectView> objects;  ///< objects in the picture, hidden ones included, ordered by id
};

/// The content of ROS's sensor_msgs/CameraInfo. Pixel centres lie at integers there, so the
/// principal point is 0.5 less than in Intrinsics.
struct CameraInfo {
  std::string frame_id;  ///< "NAME_optical_frame": Z forward, X right, Y down
  int width = 0, height = 0;
  std::string distortion_model;  ///< ROS's, or "equirectangular" or "orthographic", which it lacks
  std::vector<double> d;
  std::array<double, 9> k = {};   ///< row-major
  std::array<double, 9> r = {};   ///< row-major; the identity: pictures are not rectified
  std::array<double, 12> p = {};  ///< row-major
};
CameraInfo camera_info(const std::string& camera, const Intrinsics& intrinsics);
/// Pose in the world of a camera's optical frame.
Pose optical_pose(const Pose& X_WC);

/// One drawn geom: `part` indexes this table.
struct LabelRow {
  uint32_t part = 0;
  std::string geom, body, material;  ///< full names; "" when unnamed
  /// Id of the object (body directly under the world, or robot) it belongs to.
  uint32_t instance = 0;
  std::string instance_name;
  uint32_t semantic = 0;
  std::string semantic_name;  ///< class: robot's or object's name without trailing digits; "floor",
                              ///< "wall" …
};

}  // namespace gloam

#pragma once
// What cameras put out: one message per frame, every channel of the same instant and the same rays.

#include <cstdint>
#include <string>
#include <vector>

#include "gloam/sensor.h"
#include "gloam/types.h"

namespace gloam {

/// Pinhole intrinsics in pixels. Pixel centres lie at integer + 0.5; u to the right, v down.
struct Intrinsics {
  int width = 640, height = 480;  ///< [px]
  double fx = 0, fy = 0;          ///< focal lengths [px]
  double cx = 0, cy = 0;          ///< principal point [px] from the top left corner of the picture
  bool orthographic = false;      ///< then fx, fy are px per metre
};

/// One frame of one camera. Empty vectors are channels that were not asked for.
struct CameraFrame {
  std::string camera;  ///< full name
  int64_t index = 0;   ///< frame number since reset
  int64_t step = 0;    ///< physics step of the exposure
  double time = 0;     ///< [s] simulation time of the exposure
  bool warmup = false;
  Intrinsics intrinsics;
  double delivery = 0;  ///< [s] simulation time at which it reaches a reader, >= time
  double ev100 = 0;     ///< exposure value of `rgb` and `raw`
  Pose X_WC;            ///< pose of the camera; looks along -Z, +Y up (MuJoCo's convention)

  std::vector<uint8_t> rgb;     ///< tone-mapped sRGB, (height x width x 3)
  std::vector<float> radiance;  ///< linear Rec. 709 [cd/m²], (height x width x 3)
  std::vector<float> depth;  ///< along the optical axis [m], +inf = nothing hit, (height x width)
  std::vector<uint32_t>
      part;  ///< row of the label table (one per drawn geom), 0 = nothing, (height x width)
  std::vector<uint16_t> instance;  ///< object id of the label table, 0 = nothing, (height x width)
  std::vector<uint16_t> semantic;  ///< class id of the label table, 0 = nothing, (height x width)
  std::vector<float> normal;       ///< unit, world axes, 0 = nothing, (height x width x 3)
  std::vector<float> albedo;       ///< (height x width x 3), 0..1
  std::vector<uint32_t> samples;   ///< light paths in the mean of a pixel, (height x width)
  std::vector<float> motion;  ///< optical flow from the previous frame of this camera to this one
                              ///< [px], (height x width x 2)
  /// Numbers of the imager [DN]: behind a mosaic (height x width), else (height x width x 3).
  std::vector<uint16_t> raw;
  /// What the camera's stereo_depth model measures along the optical axis [m], 0 = nothing,
  /// (height x width). `depth` is the truth.
  std::vector<float> sensor_depth;
  std::vector<Event> events;   ///< since the frame before, in order of time
  std::vector<float> thermal;  ///< apparent temperature [K], (height x width)
};

/// One drawn geom: `part` indexes this table.
struct LabelRow {
  uint32_t part = 0;
  std::string geom, body, material;  ///< full names; "" when unnamed
  uint16_t instance =
      0;  ///< id of the object (body directly under the world, or robot) it belongs to
  std::string instance_name;
  uint16_t semantic = 0;
  std::string semantic_name;  ///< class: robot's or object's name without trailing digits; "floor",
                              ///< "wall" …
};

}  // namespace gloam

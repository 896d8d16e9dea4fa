#pragma once
// The planes that a render fills. Rows from the top; every plane is of the same rays.

#include <cstdint>
#include <map>
#include <vector>

#include "base/vec.h"
#include "gloam/camera.h"

namespace gloam {

/// Bounding boxes of one object in a picture: of its visible part, and of all of it if nothing
/// stood in front.
struct ObjectCover {
  PixelBox seen, all;
};

struct Film {
  int width = 0, height = 0;
  /// Light as RenderSettings::finish prepares it for a display: 8-bit sRGB, (height x width x 3).
  std::vector<uint8_t> rgb;
  // Light; empty where no samples are asked for, or only `rgb`.
  std::vector<Vec3f> radiance;         ///< mean over samples, linear Rec. 709 [cd/m²]
  std::vector<Vec3f> variance;         ///< of that mean, per channel; empty unless asked for
  std::vector<uint32_t> sample_count;  ///< in that mean; empty where every pixel has as many
  // Guides for a denoiser; means over samples, unless RenderSettings::guide_samples asks for
  // better.
  std::vector<Vec3f> albedo;  ///< 0..1; sky: 0
  std::vector<Vec3f> normal;  ///< shading normal, world; sky: 0
  // Exact channels: of the ray through the pixel's centre, never averaged.
  std::vector<float>
      depth;  ///< along the optical axis, of wide lenses the distance [m]; +inf = nothing
  std::vector<float> distance;       ///< along the ray [m]; +inf = nothing
  std::vector<uint32_t> part;        ///< instance index + 1; 0 = nothing
  std::vector<Vec3f> center_normal;  ///< geometric-shading normal at the centre, world; 0 = nothing
  std::vector<Vec3f> center_albedo;
  std::vector<Vec2f> motion;      ///< from the previous to this instant [px]
  std::vector<Vec3f> scene_flow;  ///< of the point that is seen, in that time, world [m]

  std::map<uint32_t, ObjectCover> cover;  ///< of the objects that a ray meets, by id, if asked for

  size_t pixel_count() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

}  // namespace gloam

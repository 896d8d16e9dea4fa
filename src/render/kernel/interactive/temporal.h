#pragma once
// The interactive tier on a card: few path samples of each picture join those of earlier pictures,
// which are found by motion vectors. Light is kept as a fraction of the surface's colour, so that
// textures stay sharp; temporal_light.h and temporal_restore.h make the shown picture of it.
// Device-safe.

#include "render/kernel/camera/camera.h"
#include "render/kernel/film/firefly.h"

namespace gloam {

/// Memory of a picture, one entry per world and pixel.
struct TemporalPlanes {
  Vec3f* light = nullptr;     ///< mean over many pictures, over the surface's colour [cd/m²]
  Vec3f* recent = nullptr;    ///< the same over the last few [cd/m²]
  Vec3f* noisy = nullptr;     ///< mean over some, of light without any filter or clamp [cd/m²]
  float* square = nullptr;    ///< the same of squared luminance [cd²/m⁴]
  float* age = nullptr;       ///< pictures that `light` is the mean of
  float* distance = nullptr;  ///< exact channel [m]
  uint32_t* part = nullptr;   ///< of part_of()
  Vec3f* normal = nullptr;    ///< exact channel center_normal
};

/// Sums over pixels, in units of the brightest one of their block.
struct PixelSums {
  Vec3f noisy, shown;
  float pixels = 0, unit = 0;  ///< unit: one over the brightest pixel, for each pixel
};
/// Sums over a block of pixels. Denoisers lose other shares of the light at borders than inside.
struct BlockLight {
  PixelSums inside, border;
};

/// One picture that joins a history; pointers are those of the side that runs the code.
struct TemporalPicture {
  int width = 0, height = 0;
  CameraView32 camera;
  const Vec3f* radiance = nullptr;    ///< of this picture, denoised if there is a denoiser
  const Vec3f* noisy = nullptr;       ///< the same before the denoiser
  const Vec3f* albedo = nullptr;      ///< exact channel center_albedo
  const uint32_t* part = nullptr;     ///< exact channel
  const float* clear = nullptr;       ///< transmittance of media before surfaces; null = no media
  const Vec2f* motion = nullptr;      ///< exact channel [px]
  const Vec3f* scene_flow = nullptr;  ///< exact channel [m]
  TemporalPlanes now, before;
  bool has_before = false;
  float weight = 1;              ///< of this picture, in usual ones: its samples over theirs
  BlockLight* blocks = nullptr;  ///< one per block of pixels, row by row
  Vec3f* color = nullptr;        ///< mean light of all pictures [cd/m²]
  Vec3f* shown = nullptr;        ///< the same with its details and all of its light [cd/m²]

  static constexpr int kBlock = 8;  ///< [px]
  GLOAM_HD int block_columns() const { return (width + kBlock - 1) / kBlock; }
  GLOAM_HD int block_rows() const { return (height + kBlock - 1) / kBlock; }
  GLOAM_HD BlockLight& block(int column, int row) const {
    return blocks[static_cast<size_t>(row) * static_cast<size_t>(block_columns()) +
                  static_cast<size_t>(column)];
  }
  GLOAM_HD size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  GLOAM_HD bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

namespace temporal {

inline constexpr float kMostAge = 48, kMostRecent = 8, kMostNoisy = 16;  ///< [pictures]
inline constexpr float kLeastColor = 0.05f;
inline constexpr float kFacing = 0.9f;     ///< cosine between normals of one surface
inline constexpr float kDistance = 0.01f;  ///< tolerance, relative
/// Pixels whose surface passes less of its light show the media before it.
inline constexpr float kLeastClear = 0.3f;
inline constexpr uint32_t kMediaPart = ~0u;  ///< `part` of such pixels
/// Bit in `part` of pixels beside another object or colour, which show the light of both.
inline constexpr uint32_t kBorder = 1u << 31;

/// Whether two pixels show one object in similar colours.
GLOAM_HD bool is_one(const TemporalPicture& p, size_t i, size_t j) {
  constexpr float kMostContrast = 3;
  const float a = max(luminance(p.albedo[i]), kLeastColor),
              b = max(luminance(p.albedo[j]), kLeastColor);
  return p.part[i] == p.part[j] && max(a, b) <= kMostContrast * min(a, b);
}
/// Value that pixels have in common if they can share their light: the exact channel with a bit for
/// pixels at a border, or kMediaPart.
GLOAM_HD uint32_t part_of(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  if (p.clear != nullptr && p.clear[i] < kLeastClear) return kMediaPart;
  const bool inside = (x == 0 || is_one(p, i, i - 1)) &&
                      (x + 1 == p.width || is_one(p, i, i + 1)) &&
                      (y == 0 || is_one(p, i, p.index(x, y - 1))) &&
                      (y + 1 == p.height || is_one(p, i, p.index(x, y + 1)));
  return inside ? p.part[i] : p.part[i] | kBorder;
}
GLOAM_HD bool is_sky(uint32_t part) { return (part & ~kBorder) == 0; }
/// Whether the pixel shows two objects or colours. It has no like pixels around: they show other
/// parts of either.
GLOAM_HD bool is_mixed(uint32_t part) { return (part & kBorder) != 0 && part != kMediaPart; }
/// Whether pixels of this value show no surface.
GLOAM_HD bool is_empty(uint32_t part) { return is_sky(part) || part == kMediaPart; }

/// Colour of a pixel's surface, never black.
GLOAM_HD Vec3f reflected_color(const TemporalPicture& p, size_t i) {
  const Vec3f albedo = p.albedo[i];
  return {max(albedo.x, kLeastColor), max(albedo.y, kLeastColor), max(albedo.z, kLeastColor)};
}

/// Colour that the light of a pixel is divided by: never black. White where light is not reflected
/// (sky, media), and where two objects share a pixel. It must not jump within a surface, whose
/// pixels exchange their quotients.
GLOAM_HD Vec3f divisor(const TemporalPicture& p, size_t i) {
  const Vec3f white{1, 1, 1};
  const uint32_t part = p.now.part[i];
  if (is_empty(part) || is_mixed(part)) return white;
  const Vec3f color = reflected_color(p, i);
  return p.clear == nullptr ? color : lerp(white, color, p.clear[i]);
}

/// Surface that a pixel of the previous picture must show to be the same place.
struct Sought {
  uint32_t part = 0;
  Vec3f normal;
  float distance = 0, tolerance = 0;  ///< from the camera as it was before [m]
};

GLOAM_HD Sought sought_at(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  Sought s{p.now.part[i], p.now.normal[i]};
  if (is_empty(s.part)) return s;
  RayCone cone;
  const Ray ray =
      camera_ray(p.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, &cone);
  const Affine3f& before = p.camera.pose.X_WC_previous;
  const Vec3f away = ray.o + ray.d * p.now.distance[i] - p.scene_flow[i] - before.p;
  s.distance = p.camera.orthographic ? -dot(away, before.z) : length(away);
  // Along a surface that is seen at a grazing angle, the next pixel is far.
  const float cosine = max(fabsf(dot(ray.d, s.normal)), 0.05f);
  const float pixel = cone.width + cone.spread * p.now.distance[i];
  s.tolerance = kDistance * fabsf(s.distance) + 2 * pixel / cosine;
  return s;
}

GLOAM_HD bool is_same(const TemporalPlanes& before, size_t j, const Sought& s) {
  if (before.part[j] != s.part) return false;
  return is_empty(s.part) || (dot(before.normal[j], s.normal) >= kFacing &&
                              fabsf(before.distance[j] - s.distance) <= s.tolerance);
}

struct Past {
  Vec3f light, recent, noisy;
  float square = 0;
  float age = 0;  ///< 0 = unknown
};

/// The history where the pixel's surface was in the picture before.
GLOAM_HD Past find_past(const TemporalPicture& p, int x, int y) {
  const Vec2f motion = p.motion[p.index(x, y)];
  const float u = static_cast<float>(x) - motion.x, v = static_cast<float>(y) - motion.y;
  const float right = static_cast<float>(p.width) - 0.5f;
  const float low = static_cast<float>(p.height) - 0.5f;
  Past past;
  if (!p.has_before || !(u > -0.5f && u < right && v > -0.5f && v < low)) return past;
  const Sought sought = sought_at(p, x, y);
  const float left = floorf(u), top = floorf(v);
  float total = 0;
  for (int k = 0; k < 4; ++k) {
    const int a = static_cast<int>(left) + k % 2, b = static_cast<int>(top) + k / 2;
    const float weight =
        (k % 2 == 0 ? left + 1 - u : u - left) * (k / 2 == 0 ? top + 1 - v : v - top);
    if (!(weight > 0) || !p.holds(a, b)) continue;
    const size_t j = p.index(a, b);
    if (!is_same(p.before, j, sought)) continue;
    past.light += p.before.light[j] * weight;
    past.recent += p.before.recent[j] * weight;
    past.noisy += p.before.noisy[j] * weight;
    past.square += p.before.square[j] * weight;
    past.age += p.before.age[j] * weight;
    total += weight;
  }
  constexpr float kLeastWeight = 0.01f;
  if (total < kLeastWeight) return {};
  return {past.light / total, past.recent / total, past.noisy / total, past.square / total,
          past.age / total};
}

/// Adds this picture's light of a pixel to its history.
GLOAM_HD void accumulate(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  p.now.part[i] = part_of(p, x, y);
  const Vec3f color = divisor(p, i), light = fireflies::sanitize(p.radiance[i]);
  const Vec3f fresh{light.x / color.x, light.y / color.y, light.z / color.z};
  const Past past = find_past(p, x, y);
  const float age = past.age + p.weight;
  const Vec3f noisy = fireflies::sanitize(p.noisy[i]);
  const auto mean = [&](auto before, auto now, float most) {
    return before + (now - before) * min(p.weight / min(age, most), 1);
  };
  p.now.light[i] = mean(past.light, fresh, kMostAge);
  p.now.recent[i] = mean(past.recent, fresh, kMostRecent);
  p.now.noisy[i] = mean(past.noisy, noisy, kMostNoisy);
  p.now.square[i] = mean(past.square, luminance(noisy) * luminance(noisy), kMostNoisy);
  p.now.age[i] = min(age, kMostAge);
}

}  // namespace temporal
}  // namespace gloam

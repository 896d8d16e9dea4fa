#pragma once
// The interactive tier on a card: few path samples of each picture join those of earlier pictures,
// which are found by motion vectors. Light is kept as a fraction of the surface's colour, so that
// textures stay sharp. Device-safe.

#include "render/kernel/camera/camera.h"

namespace gloam {

/// Memory of a picture, one entry per world and pixel.
struct TemporalPlanes {
  Vec3f* light = nullptr;     ///< mean over many pictures, over the surface's colour [cd/m²]
  Vec3f* recent = nullptr;    ///< the same over the last few [cd/m²]
  float* age = nullptr;       ///< pictures that `light` is the mean of
  float* distance = nullptr;  ///< exact channel [m]
  uint32_t* part = nullptr;   ///< exact channel
  Vec3f* normal = nullptr;    ///< exact channel center_normal
};

/// One picture that joins a history; pointers are those of the side that runs the code.
struct TemporalPicture {
  int width = 0, height = 0;
  CameraView32 camera;
  const Vec3f *radiance = nullptr, *albedo = nullptr;  ///< of this picture, noisy; without edges
  const Vec2f* motion = nullptr;                       ///< exact channel [px]
  const Vec3f* scene_flow = nullptr;                   ///< exact channel [m]
  TemporalPlanes now, before;
  bool has_before = false;
  float weight = 1;        ///< of this picture, in usual ones: its samples over theirs
  Vec3f* color = nullptr;  ///< mean light of all pictures [cd/m²]

  GLOAM_HD size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  GLOAM_HD bool holds(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

namespace temporal {

inline constexpr float kMostAge = 48, kMostRecent = 8;  ///< [pictures]
inline constexpr float kLeastColor = 0.02f;
inline constexpr float kFacing = 0.9f;     ///< cosine between normals of one surface
inline constexpr float kDistance = 0.01f;  ///< tolerance, relative
/// Pixels around one that its recent light is compared with: so many to each side, and their
/// distance, which reaches over the blotches that a denoiser leaves [px].
inline constexpr int kWindow = 2, kWindowStep = 4;
/// Light that is shown of a pixel with a short history: places around it, and the widest distance
/// [px].
inline constexpr int kSpreadTaps = 24;
inline constexpr float kWidestSpread = 24;
/// Light farther from the recent light around than so many of its standard deviations has changed.
inline constexpr float kMostDeviations = 2;

GLOAM_HD float finite_light(float x) { return x > 0 && x < INFINITY ? min(x, 1e9f) : 0.0f; }

/// Colour that the light of a pixel is divided by: never black, and of the sky white.
GLOAM_HD Vec3f divisor(Vec3f albedo, uint32_t part) {
  if (part == 0) return {1, 1, 1};
  return {max(albedo.x, kLeastColor), max(albedo.y, kLeastColor), max(albedo.z, kLeastColor)};
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
  if (s.part == 0) return s;
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
  return s.part == 0 || (dot(before.normal[j], s.normal) >= kFacing &&
                         fabsf(before.distance[j] - s.distance) <= s.tolerance);
}

struct Past {
  Vec3f light, recent;
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
    past.age += p.before.age[j] * weight;
    total += weight;
  }
  constexpr float kLeastWeight = 0.01f;
  if (total < kLeastWeight) return {};
  return {past.light / total, past.recent / total, past.age / total};
}

/// Adds this picture's light of a pixel to its history.
GLOAM_HD void accumulate(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  const Vec3f color = divisor(p.albedo[i], p.now.part[i]), light = p.radiance[i];
  const Vec3f fresh{finite_light(light.x) / color.x, finite_light(light.y) / color.y,
                    finite_light(light.z) / color.z};
  const Past past = find_past(p, x, y);
  const float age = past.age + p.weight;
  const auto mean = [&](Vec3f before, float most) {
    return before + (fresh - before) * min(p.weight / min(age, most), 1);
  };
  p.now.light[i] = mean(past.light, kMostAge);
  p.now.recent[i] = mean(past.recent, kMostRecent);
  p.now.age[i] = min(age, kMostAge);
}

/// Whether another pixel shows the surface of a pixel.
GLOAM_HD bool is_alike(const TemporalPicture& p, size_t j, size_t i) {
  return p.now.part[j] == p.now.part[i] &&
         (p.now.part[i] == 0 || dot(p.now.normal[j], p.now.normal[i]) >= kFacing);
}

/// Brings a mean of many pictures back to the recent light of the pixels around, where shadows and
/// lamps have moved. After accumulate() of all pixels.
GLOAM_HD void settle(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  Vec3f sum, squares;
  float count = 0;
  for (int k = 0; k < (2 * kWindow + 1) * (2 * kWindow + 1); ++k) {
    const int a = x + kWindowStep * (k % (2 * kWindow + 1) - kWindow);
    const int b = y + kWindowStep * (k / (2 * kWindow + 1) - kWindow);
    if (!p.holds(a, b) || !is_alike(p, p.index(a, b), i)) continue;
    const Vec3f recent = p.now.recent[p.index(a, b)];
    sum += recent;
    squares += recent * recent;
    count += 1;
  }
  if (count < 2) return;  // a pixel by itself knows no deviation
  const Vec3f mean = sum / count, light = p.now.light[i];
  const auto clamped = [&](float value, float center, float square) {
    const float reach = kMostDeviations * safe_sqrt(square - center * center);
    return clamp(value, max(center - reach, 0), center + reach);
  };
  p.now.light[i] = {clamped(light.x, mean.x, squares.x / count),
                    clamped(light.y, mean.y, squares.y / count),
                    clamped(light.z, mean.z, squares.z / count)};
}

/// Light of a pixel and of its surface around: the shorter its history, the wider. In fixed places,
/// so that what rests does not flicker. After settle() of all pixels.
GLOAM_HD Vec3f shown_light(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  const float reach = kWidestSpread * max(1 - p.now.age[i] / kMostAge, 0);
  Vec3f sum = p.now.light[i];
  float total = 1;
  for (int k = 1; p.now.part[i] != 0 && reach > 0 && k <= kSpreadTaps; ++k) {
    constexpr float kGoldenTurn = 0.381966f;  // a spiral of evenly dense places
    const float share = static_cast<float>(k) / kSpreadTaps, r = reach * sqrtf(share);
    const float turns = kGoldenTurn * static_cast<float>(k);
    float sine, cosine;
    sincos_turn(turns - floorf(turns), &sine, &cosine);
    const int a = x + static_cast<int>(floorf(r * cosine + 0.5f));
    const int b = y + static_cast<int>(floorf(r * sine + 0.5f));
    if (!p.holds(a, b) || !is_alike(p, p.index(a, b), i)) continue;
    const float weight = 1 - 0.5f * share;
    sum += p.now.light[p.index(a, b)] * weight;
    total += weight;
  }
  return sum / total;
}

/// Makes the pixel's colour.
GLOAM_HD void compose(const TemporalPicture& p, int x, int y) {
  const size_t i = p.index(x, y);
  p.color[i] = shown_light(p, x, y) * divisor(p.albedo[i], p.now.part[i]);
}

}  // namespace temporal
}  // namespace gloam

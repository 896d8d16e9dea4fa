#pragma once
// Fireflies of one picture: pixels far brighter than everything around them. Device-safe.

#include "base/vec.h"

namespace gloam {

/// A noisy picture and the guides that say where a firefly's light may go.
struct FireflyView {
  int width = 0, height = 0;
  const Vec3f* color = nullptr;       ///< without what is no number [cd/m²]
  const float* brightness = nullptr;  ///< luminance of it
  const Vec3f* albedo = nullptr;      ///< null = white
  const Vec3f* normal = nullptr;      ///< null = all face the same way

  GLOAM_HD size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

/// A firefly that has been brought down to its limit.
struct Firefly {
  Vec3f dimmed;  ///< [cd/m²] that it has from now on
  Vec3f kept;    ///< [cd/m²] of it that the picture is to keep, `dimmed` among it
  Vec3f spread;  ///< [cd/m²] that each pixel around gets, on white surfaces that face its way
};

namespace fireflies {

inline constexpr float kRatio = 4;           // to the third brightest of the pixels around
inline constexpr int kRadius = 2;            // of those [px]
inline constexpr int kSpreadRadius = 16;     // how far the light of a firefly is spread [px]
inline constexpr float kMostSpread = 0.02f;  // fraction of its limit that one pixel may get of it
inline constexpr float kMostKept = 10;       // light of a firefly, in that of all pixels around it
inline constexpr float kFacing = 0.9f;       // cosine between surfaces that take each other's light

/// Values that are infinite or no number are errors elsewhere, not light.
GLOAM_HD float sanitize(float x) { return x > 0 && x < INFINITY ? min(x, 1e9f) : 0.0f; }
GLOAM_HD Vec3f sanitize(Vec3f c) { return {sanitize(c.x), sanitize(c.y), sanitize(c.z)}; }

GLOAM_HD int first(int at, int radius) { return at > radius ? at - radius : 0; }
GLOAM_HD int last(int at, int radius, int count) {
  return at + radius < count ? at + radius : count - 1;
}

GLOAM_HD bool faces(const FireflyView& v, size_t i, size_t j) {
  return v.normal == nullptr || dot(v.normal[i], v.normal[j]) >= kFacing;
}
GLOAM_HD Vec3f albedo(const FireflyView& v, size_t i) {
  if (v.albedo == nullptr) return {1, 1, 1};
  constexpr float kMinReflectance = 0.02f;  // black surfaces reflect a little too
  const Vec3f a = v.albedo[i];
  return {max(a.x, kMinReflectance), max(a.y, kMinReflectance), max(a.z, kMinReflectance)};
}

/// Calls visit(pixel) for all pixels that the light of a firefly at (x, y) may be spread over, row
/// by row.
template <class Visit>
GLOAM_HD void around(const FireflyView& v, int x, int y, const Visit& visit) {
  for (int b = first(y, kSpreadRadius); b <= last(y, kSpreadRadius, v.height); ++b) {
    for (int a = first(x, kSpreadRadius); a <= last(x, kSpreadRadius, v.width); ++a)
      visit(v.index(a, b));
  }
}

/// Third brightest of the pixels around (x, y).
GLOAM_HD float third_around(const FireflyView& v, int x, int y) {
  float brightest[3] = {};
  for (int b = first(y, kRadius); b <= last(y, kRadius, v.height); ++b) {
    for (int a = first(x, kRadius); a <= last(x, kRadius, v.width); ++a) {
      if (a == x && b == y) continue;
      float value = v.brightness[v.index(a, b)];
      for (float& known : brightest) {
        const float less = min(value, known);
        known = max(value, known);
        value = less;
      }
    }
  }
  return brightest[2];
}

/// Whether the pixel (x, y) is a firefly, and then its new light. Among all-black neighbours there
/// is nothing to compare with: the pixel stays.
GLOAM_HD bool dim(const FireflyView& v, int x, int y, Firefly* fly) {
  const size_t i = v.index(x, y);
  const float limit = kRatio * third_around(v, x, y);
  if (!(limit > 0 && v.brightness[i] > limit)) return false;
  fly->dimmed = v.color[i] * (limit / v.brightness[i]);
  const Vec3f a = albedo(v, i), excess = v.color[i] - fly->dimmed;
  float light = 0;  // of other fireflies what would be no firefly here
  Vec3f reflected;
  around(v, x, y, [&](size_t j) {
    light += min(v.brightness[j], limit);
    if (faces(v, i, j)) reflected += albedo(v, j);
  });
  fly->kept = fly->dimmed + excess * min(1, kMostKept * light / luminance(excess));
  fly->spread = {excess.x / a.x, excess.y / a.y, excess.z / a.z};
  const float received = luminance(fly->spread * reflected);
  if (!(received > 0)) {  // nothing around looks the same way
    fly->spread = {};
    return true;
  }
  const float most = kMostSpread * limit / luminance(fly->spread);
  fly->spread *= min(luminance(excess) / received, most);
  return true;
}

}  // namespace fireflies
}  // namespace gloam

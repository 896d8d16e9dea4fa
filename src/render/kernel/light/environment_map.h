#pragma once
// Light from far away: an equirectangular map around the scene, filtered look-ups, and directions
// sampled in proportion to it. Device-safe.
//
// The map's own frame E has Z up; row 0 is at the zenith, the middle column lies along +X, and
// columns run to the right as one sees them from inside (from +X by -Y). Texels are points at their
// centres: columns repeat, rows are clamped at the poles.
//
// Density. What `radiance` returns is the sum over texels of value times a tent in u and in v. A
// direction is sampled from the same sum with weights for values: a texel by its weight, then a
// point of its tent. So the density is positive wherever the radiance is, and both are continuous.
// It is computed from the very numbers that the choice compares with, not from the texels again:
// the rounding of sums over a map with a sun in it costs noise, no bias.

#include "base/vec.h"

namespace gloam {

/// A picture of the mip pyramid.
struct EnvironmentLevel {
  uint32_t first = 0;  ///< index of its texel (0, 0)
  int width = 0, height = 0;
};

struct EnvironmentView {
  DeviceSpan<const Vec3f> texels;             ///< linear Rec. 709, all levels, rows from the zenith
  DeviceSpan<const EnvironmentLevel> levels;  ///< from fine to coarse; empty = no environment
  DeviceSpan<const float> row_cdf;     ///< over the rows of the first level: (height + 1), 0 to 1
  DeviceSpan<const float> column_cdf;  ///< within each row: (height x (width + 1)), 0 to 1
  Frame R_WE;                          ///< E's axes in W
  float scale = 1;                     ///< [cd/m²] of a texel of one
  float illuminance = 0;  ///< luminance over the whole sphere, scale included [cd sr/m² = lx]
  bool changes = false;   ///< it may be another one in every picture
};

struct EnvironmentSample {
  Vec3f wi;        ///< unit, towards the environment
  Vec3f radiance;  ///< [cd/m²], of the finest level
  float pdf = 0;   ///< per solid angle; 0 = none: the map is black
};

namespace environments {

/// Neighbours of a point between texel centres, and the fraction of the second.
struct Between {
  int low, high;
  float fraction;
};
/// `x` in [0, 1] over n columns that repeat.
GLOAM_HD Between between_columns(float x, int n) {
  const float f = x * static_cast<float>(n) - 0.5f, base = floorf(f);
  const int low = static_cast<int>(base), high = low + 1;
  return {low < 0 ? n - 1 : (low >= n ? 0 : low), high >= n ? 0 : high, f - base};
}
/// `y` in [0, 1] over n rows that are clamped.
GLOAM_HD Between between_rows(float y, int n) {
  const float f = y * static_cast<float>(n) - 0.5f, base = floorf(f);
  const int low = static_cast<int>(base), high = low + 1;
  return {low < 0 ? 0 : (low >= n ? n - 1 : low), high >= n ? n - 1 : high, f - base};
}

GLOAM_HD Vec3f bilinear(const EnvironmentView& map, const EnvironmentLevel& level, Vec2f uv) {
  const Between x = between_columns(uv.x, level.width), y = between_rows(uv.y, level.height);
  const Vec3f* row0 = map.texels.data + level.first + static_cast<size_t>(y.low) * level.width;
  const Vec3f* row1 = map.texels.data + level.first + static_cast<size_t>(y.high) * level.width;
  return lerp(lerp(row0[x.low], row0[x.high], x.fraction),
              lerp(row1[x.low], row1[x.high], x.fraction), y.fraction);
}

/// Density of the sampled (u, v) over the unit square.
GLOAM_HD float density(const EnvironmentView& map, Vec2f uv) {
  const EnvironmentLevel& level = map.levels[0];
  const Between x = between_columns(uv.x, level.width), y = between_rows(uv.y, level.height);
  const size_t stride = static_cast<size_t>(level.width) + 1;
  const float* row0 = map.column_cdf.data + static_cast<size_t>(y.low) * stride;
  const float* row1 = map.column_cdf.data + static_cast<size_t>(y.high) * stride;
  const auto in_row = [&](const float* cdf) {
    return lerp(cdf[x.low + 1] - cdf[x.low], cdf[x.high + 1] - cdf[x.high], x.fraction);
  };
  const float* rows = map.row_cdf.data;
  return lerp((rows[y.low + 1] - rows[y.low]) * in_row(row0),
              (rows[y.high + 1] - rows[y.high]) * in_row(row1), y.fraction) *
         static_cast<float>(level.width) * static_cast<float>(level.height);
}

/// The step of a running sum, `cdf` (n + 1), that u in [0, 1) falls into; u becomes its place
/// within the step.
GLOAM_HD int choose(const float* cdf, int n, float* u) {
  int low = 0, high = n;  // cdf[low] <= u < cdf[high]
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (cdf[middle] <= *u) {
      low = middle;
    } else {
      high = middle;
    }
  }
  *u = clamp((*u - cdf[low]) / (cdf[low + 1] - cdf[low]), 0.0f, 0.99999994f);
  return low;
}

/// A point of the tent over (-1, 1).
GLOAM_HD float tent(float u) {
  return u < 0.5f ? square_root(2.0f * u) - 1.0f : 1.0f - square_root(2.0f - 2.0f * u);
}

GLOAM_HD Vec2f uv_of(Vec3f d_E) {
  return {0.5f - atan2f(d_E.y, d_E.x) * (0.5f * kInvPi),
          atan2f(square_root(d_E.x * d_E.x + d_E.y * d_E.y), d_E.z) * kInvPi};
}

/// Per solid angle from the density over the unit square: du dv = dω / (2 π² sin θ). At the poles
/// the density has no bound; half a ulp beside them it is cut.
GLOAM_HD float per_solid_angle(float density, float sine) {
  return density * (0.5f * kInvPi * kInvPi) / max(sine, 1e-7f);
}

}  // namespace environments

/// Radiance from the unit direction d_W [cd/m²], filtered over a cone of the full angle `footprint`
/// [rad]; 0 = bilinear, as it is sampled.
GLOAM_HD Vec3f environment_radiance(const EnvironmentView& map, Vec3f d_W, float footprint) {
  if (map.levels.empty()) return {};
  const Vec2f uv = environments::uv_of(map.R_WE.to_local(d_W));
  const float texels_wide = footprint * kInvPi * static_cast<float>(map.levels[0].height);
  const float lod = texels_wide > 1.0f ? log2f(texels_wide) : 0.0f;
  const float level = min(lod, static_cast<float>(map.levels.size - 1));
  const uint32_t base = static_cast<uint32_t>(level);
  const float fraction = level - static_cast<float>(base);
  const Vec3f fine = environments::bilinear(map, map.levels[base], uv);
  if (fraction == 0.0f) return fine * map.scale;
  return lerp(fine, environments::bilinear(map, map.levels[base + 1], uv), fraction) * map.scale;
}

/// Density per solid angle with which environment_sample makes the unit direction d_W.
GLOAM_HD float environment_pdf(const EnvironmentView& map, Vec3f d_W) {
  if (map.row_cdf.empty()) return 0.0f;
  const Vec3f d_E = map.R_WE.to_local(d_W);
  return environments::per_solid_angle(environments::density(map, environments::uv_of(d_E)),
                                       square_root(d_E.x * d_E.x + d_E.y * d_E.y));
}

/// A direction by `u` in [0, 1)².
GLOAM_HD EnvironmentSample environment_sample(const EnvironmentView& map, Vec2f u) {
  EnvironmentSample s;
  if (map.row_cdf.empty()) return s;
  const int width = map.levels[0].width, height = map.levels[0].height;
  const int row = environments::choose(map.row_cdf.data, height, &u.y);
  const int column = environments::choose(
      map.column_cdf.data + static_cast<size_t>(row) * (static_cast<size_t>(width) + 1), width,
      &u.x);
  float x =
      (static_cast<float>(column) + 0.5f + environments::tent(u.x)) / static_cast<float>(width);
  float y = (static_cast<float>(row) + 0.5f + environments::tent(u.y)) / static_cast<float>(height);
  x = x < 0.0f ? x + 1.0f : (x > 1.0f ? x - 1.0f : x);
  y = y < 0.0f ? -y : (y > 1.0f ? 2.0f - y : y);  // a clamped row is its own neighbour
  const float phi = (0.5f - x) * 2.0f * kPi, sine = sinf(y * kPi);
  s.wi = map.R_WE.to_world({sine * cosf(phi), sine * sinf(phi), cosf(y * kPi)});
  s.radiance = environments::bilinear(map, map.levels[0], {x, y}) * map.scale;
  s.pdf = environments::per_solid_angle(environments::density(map, {x, y}), sine);
  return s;
}

}  // namespace gloam

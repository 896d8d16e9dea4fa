#pragma once
// Points of media that glow, sampled in proportion to their emission: light that a small flame
// sends into a room is seldom found by chance (Villemin and Hery 2013, "Practical illumination from
// flames"). Emission that rays meet on their way is weighted against it, by multiple importance
// sampling point by point, so that points close by and inside of the medium do no harm.
// Device-safe.

#include "render/kernel/light/light.h"
#include "render/kernel/media/medium.h"

namespace gloam::glow {

/// Bound, up to a factor, of the illuminance by a source within `reach` of `to` at a surface with
/// the normal n, or at a point that takes light from all sides (n = 0), over the source's intensity
/// [1/m²]; as light_weight(). Nearer than `least` [m] it does not grow.
GLOAM_HD float point_weight(Vec3f to, float reach, float least, Vec3f n) {
  const float d2 = max(dot(to, to), sqr(least));
  float cosine = 1;
  if (length_squared(n) > 0) {
    const float height = dot(to, n) + reach;
    if (!(height > 0)) return 0;
    cosine = min(height / sqrtf(d2), 1.0f);
  }
  return (cosine + 0.05f) / d2;
}

/// Weight of a medium, for a point p with the normal n.
GLOAM_HD float weight(const GlowView& glow, Vec3f p, Vec3f n) {
  return glow.strength * point_weight(glow.center - p, glow.reach, max(glow.reach, 1e-4f), n);
}

/// Weight of all of them.
GLOAM_HD float weight(const DeviceSpan<const GlowView>& glows, Vec3f p, Vec3f n) {
  float sum = 0;
  for (uint32_t k = 0; k < glows.size; ++k) sum += weight(glows[k], p, n);
  return sum;
}

/// The last of `count` entries whose running sum is not above `pick`.
GLOAM_HD uint32_t find(const float* sums, uint32_t count, float pick) {
  uint32_t low = 0;
  while (count > 1) {
    const uint32_t half = count / 2;
    if (sums[low + half] <= pick) {
      low += half;
      count -= half;
    } else {
      count = half;
    }
  }
  return low;
}

/// Collisions per metre at a point of a cell, of the mean band: what makes a density of directions
/// into one of points that rays find.
GLOAM_HD float collision_rate(const VolumeView& volume, uint32_t cell) {
  const Vec3f k = Bands{}.of(volume.mass_extinction);
  return (k.x + k.y + k.z) * (1.0f / 3) * volume.cells[cell].high;
}

GLOAM_HD uint32_t cell_along(float x, int cells) {
  return static_cast<uint32_t>(clamp(static_cast<int>(x * (1.0f / kBoundsVoxels)), 0, cells - 1));
}

GLOAM_HD uint32_t cell_at(const VolumeView& v, Vec3f p_G) {
  const uint32_t i = cell_along(p_G.x, v.cells_x), j = cell_along(p_G.y, v.cells_y),
                 k = cell_along(p_G.z, v.cells_z);
  return (k * static_cast<uint32_t>(v.cells_y) + j) * static_cast<uint32_t>(v.cells_x) + i;
}

/// Density of points that sample() takes, at p_G in the volume [1/m³].
GLOAM_HD float point_density(const MediaView& media, const GlowView& glow, Vec3f p_G) {
  const VolumeView& v = media.volumes[glow.volume];
  const uint32_t cell = cell_at(v, p_G);
  const int row = glow.rows[cell];
  if (row < 0) return 0;
  const auto within = [](float at, int cells) {
    const int voxel =
        static_cast<int>(at) - static_cast<int>(cell_along(at, cells)) * kBoundsVoxels;
    return static_cast<uint32_t>(clamp(voxel, 0, kBoundsVoxels - 1));
  };
  const uint32_t voxel =
      (within(p_G.z, v.cells_z) * kBoundsVoxels + within(p_G.y, v.cells_y)) * kBoundsVoxels +
      within(p_G.x, v.cells_x);
  const float* sums = glow.voxel_sums.data + static_cast<size_t>(row) * GlowView::kSums + voxel;
  const float probability = (glow.cell_sums[cell + 1] - glow.cell_sums[cell]) * (sums[1] - sums[0]);
  return probability * glow.voxels_per_volume;
}

/// Density with which sample() finds the point x, p_G in the volume, from p: per solid angle, for
/// the fraction of it that rays find there.
GLOAM_HD float pdf(const MediaView& media, const GlowView& glow, Vec3f p, Vec3f x, Vec3f p_G) {
  const VolumeView& v = media.volumes[glow.volume];
  const float density = point_density(media, glow, p_G);
  if (!(density > 0)) return 0;
  return density * length_squared(x - p) / collision_rate(v, cell_at(v, p_G));
}

/// A point of the medium, by what it gives off: its voxel by u.x.
struct PointSample {
  Vec3f p_G;
  uint32_t cell = 0;
  float density = 0;  ///< [1/m³]; 0 = none
};
GLOAM_HD PointSample sample_point(const VolumeView& v, const GlowView& glow, Vec2f u) {
  PointSample s;
  const float* cells = glow.cell_sums.data;
  s.cell = find(cells, glow.cell_sums.size - 1, u.x);
  const int row = glow.rows[s.cell];
  if (row < 0) return s;
  const float of_cell = cells[s.cell + 1] - cells[s.cell];
  const float* sums = glow.voxel_sums.data + static_cast<size_t>(row) * GlowView::kSums;
  const uint32_t voxel = find(sums, GlowView::kSums - 1, rest_of(u.x, cells[s.cell], of_cell));
  const uint32_t nx = static_cast<uint32_t>(v.cells_x), ny = static_cast<uint32_t>(v.cells_y);
  const auto at = [](uint32_t of_cells, uint32_t of_voxels, float inside) {
    return static_cast<float>(of_cells * kBoundsVoxels + of_voxels % kBoundsVoxels) + inside;
  };
  WalkRandom random(u);  // the choice of a voxel leaves too little of u.x
  s.p_G = {at(s.cell % nx, voxel, random.next()), at(s.cell / nx % ny, voxel / kBoundsVoxels, u.y),
           at(s.cell / (nx * ny), voxel / (kBoundsVoxels * kBoundsVoxels), random.next())};
  s.density = of_cell * (sums[voxel + 1] - sums[voxel]) * glow.voxels_per_volume;
  return s;
}

/// Sample of that point as a light for p.
GLOAM_HD LightSample sample(const MediaView& media, const GlowView& glow, Vec3f p, Vec2f u) {
  LightSample s;
  const VolumeView& v = media.volumes[glow.volume];
  const PointSample point = sample_point(v, glow, u);
  const Vec3f to = transform_point(glow.X_WG, point.p_G) - p;
  s.distance = length(to);
  if (!(point.density > 0 && s.distance > 1e-6f)) return s;
  s.wi = to / s.distance;
  const float rate = collision_rate(v, point.cell);
  const Vec3f absorption = Bands{}.of(v.mass_extinction) * (Vec3f{1, 1, 1} - Bands{}.of(v.albedo));
  s.radiance = absorption * media::glow_at(media, v, point.p_G, {}) *
               (media::density_at(v, point.p_G) / rate);
  s.pdf = point.density * sqr(s.distance) / rate;
  if (!(max_component(s.radiance) > 0)) s.pdf = 0;
  return s;
}

/// One of them by weight(), by u.x; u.x becomes what is left of it.
struct Choice {
  const GlowView* glow = nullptr;
  float probability = 0;  ///< 0 = none
};
GLOAM_HD Choice choose(const MediaView& media, Vec3f p, Vec3f n, Vec2f* u) {
  const DeviceSpan<const GlowView>& glows = media.glows;
  const float total = weight(glows, p, n), wanted = u->x * total;
  float before = 0, taken = 0;
  uint32_t row = 0;
  for (uint32_t k = 0; k < glows.size && before + taken <= wanted; ++k) {
    const float each = weight(glows[k], p, n);
    if (!(each > 0)) continue;
    before += taken;
    taken = each;
    row = k;
  }
  if (!(taken > 0)) return {};
  u->x = rest_of(wanted, before, taken);
  return {&glows[row], taken / total};
}

/// A point of one of them, by weight().
GLOAM_HD LightSample sample(const MediaView& media, Vec3f p, Vec3f n, Vec2f u) {
  const Choice choice = choose(media, p, n, &u);
  if (!(choice.probability > 0)) return {};
  // A choice with a probability has a glow. NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker)
  LightSample s = sample(media, *choice.glow, p, u);
  s.pdf *= choice.probability;
  return s;
}

}  // namespace gloam::glow

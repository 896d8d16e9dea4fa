#pragma once
// The cells of the light guide: where they lie, and which points of static surfaces they hold.

#include <vector>

#include "render/cpu/tracer/embree_scene.h"
#include "render/kernel/light/light_sampler.h"
#include "render/kernel/math/sampler.h"
#include "render/kernel/media/medium.h"

namespace gloam {

/// A grid, without its tables, over most of the geoms in `rows`, `along` cells on its longest edge.
/// A lawn around a house must not make its cells coarse: the outermost geoms are not covered. nx is
/// 0 where there is nothing to cover.
LightGuide place_guide_grid(const SceneView& scene, DeviceSpan<const uint32_t> rows, int along);

/// Point at the fraction u of each edge of the cell [m].
Vec3f point_in_cell(const LightGuide& grid, int cell, Vec3f u);

struct SurfacePoint {
  Vec3f p, n;  ///< just off the surface [m], and its unit normal
};

/// Place where the rays of one row of the guide start: at surfaces, or anywhere in the cell.
struct GuideRow {
  int cell = 0;
  int facing = -1;  ///< -1: anywhere
  std::vector<SurfacePoint> points;
};

/// Start of ray `ray` of the row; n = 0: anywhere in the cell.
SurfacePoint start_of(const LightGuide& grid, const GuideRow& row, int ray, Sampler* sampler);

/// Points in the cell on the outside of static surfaces that face `facing` (LightGuide::facing_of).
std::vector<SurfacePoint> find_surface(const SceneView& scene, const CpuTracer& statics,
                                       const LightGuide& grid, int cell, int facing);

/// The row and up to six like it in cells that share a face with its own.
int neighborhood(const LightGuide& grid, const std::vector<GuideRow>& rows, int row, int* out);

/// Draws for ray `ray` of the row `row`; `purpose` keeps those for different ends apart.
Sampler guide_sampler(int row, int ray, uint32_t purpose);

/// Luminance that media let through along the ray, up to its end.
inline float clearness(const MediaView& media, const Ray& ray, int row, int i) {
  if (media.volumes.empty()) return 1;
  Sampler sampler = guide_sampler(row, i, 6);
  return luminance(transmittance(media, ray, ray.tmax, {}, WalkRandom(sampler.next_2d())));
}

inline Vec3f next_3d(Sampler* sampler) {
  const Vec2f a = sampler->next_2d();
  return {a.x, a.y, sampler->next_1d()};
}

}  // namespace gloam

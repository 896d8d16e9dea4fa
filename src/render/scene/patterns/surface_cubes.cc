#include "render/scene/patterns/surface_cubes.h"

#include <algorithm>
#include <cmath>

#include "render/kernel/surface/baked_lookup.h"
#include "render/scene/patterns/faced_triangle.h"
#include "render/scene/patterns/shape_mesh.h"

namespace gloam {
namespace {

/// How far a hit may lie off the triangles [m]: rounding; of round shapes how far they bulge.
float margin_of(const PatternSurface& surface) {
  const Vec3f extent = surface.high - surface.low;
  const float size = max(extent.x, max(extent.y, extent.z));
  const float bulge = surface.is_round() ? 0.5f * (1.0f - std::cos(kPi / kRoundSegments)) : 0.0f;
  return size * (1e-5f + bulge);
}

struct CubeGrid {
  Vec3f low;   ///< along_face() [m]
  float edge;  ///< [m]
  float margin;
  uint32_t table;
  int face;
  bool is_sheet;
};

void add_cubes(const CubeGrid& grid, const FacedTriangle& t, uint32_t triangle,
               std::vector<CubeTriangle>* out) {
  const auto cube = [&](float x) { return baking::cube_of(x / grid.edge); };
  const uint32_t i0 = cube(t.low.x - grid.margin - grid.low.x),
                 i1 = cube(t.high.x + grid.margin - grid.low.x),
                 j0 = cube(t.low.y - grid.margin - grid.low.y),
                 j1 = cube(t.high.y + grid.margin - grid.low.y);
  const float half = 0.5f * grid.edge + grid.margin;
  const float rise = half * (std::fabs(t.per_u) + std::fabs(t.per_v));
  for (uint32_t j = j0; j <= j1; ++j) {
    const float v = grid.low.y + (static_cast<float>(j) + 0.5f) * grid.edge;
    for (uint32_t i = i0; i <= i1; ++i) {
      const float u = grid.low.x + (static_cast<float>(i) + 0.5f) * grid.edge;
      if (!t.touches(u, v, half)) continue;
      uint32_t k0 = 0, k1 = 0;
      if (!grid.is_sheet) {
        const float z = t.height(u, v);
        k0 = cube(max(z - rise, t.low.z) - grid.margin - grid.low.z);
        k1 = cube(min(z + rise, t.high.z) + grid.margin - grid.low.z);
      }
      for (uint32_t k = k0; k <= k1; ++k)
        out->push_back({baking::tile_key(grid.table, grid.face, i, j, k), triangle});
    }
  }
}

}  // namespace

std::vector<CubeTriangle> list_cubes(const PatternSurface& surface) {
  std::vector<CubeTriangle> out;
  float edge = surface.texel * baking::kSide;
  const auto triangles = static_cast<uint32_t>(surface.mesh->triangle_count());
  for (int table = 0; table < surface.tables; ++table, edge *= baking::kSide) {
    for (int face = 0; face < 6; ++face) {
      const CubeGrid grid{baking::along_face(surface.low, face),
                          edge,
                          margin_of(surface),
                          surface.first_table + static_cast<uint32_t>(table),
                          face,
                          surface.is_sheet};
      for (uint32_t triangle = 0; triangle < triangles; ++triangle) {
        if (const auto faced = FacedTriangle::make(surface, triangle, face))
          add_cubes(grid, *faced, triangle, &out);
      }
    }
  }
  std::sort(out.begin(), out.end(), [](const CubeTriangle& a, const CubeTriangle& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  return out;
}

}  // namespace gloam

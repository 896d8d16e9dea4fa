#include "world/effects/visual_soil.h"

#include <algorithm>
#include <array>

#include "scene/options/weather_fields.h"
#include "world/materials/visual_surface.h"

namespace gloam {
namespace {

/// Albedo and roughness; `grain` between lumps of two tones, with what they stand out.
struct SoilLook {
  Vec3f color;
  float roughness, tone, grain, height;  // `tone`: of the darker lumps, `grain`, `height` [m]
};
// Dry sand 0.35 to 0.4, moist loam and clay 0.1 to 0.2, wet mud below (Oke 1987, "Boundary Layer
// Climates", table 1.1); fresh snow 0.9 in visible light; lunar soil 0.12.
constexpr std::array<SoilLook, kSoilKinds.size()> kLooks = {{
    {{0.46f, 0.36f, 0.24f}, 0.95f, 0.72f, 0.012f, 0.0006f},  // dry_sand
    {{0.21f, 0.145f, 0.09f}, 0.95f, 0.6f, 0.03f, 0.0015f},   // sandy_loam
    {{0.2f, 0.125f, 0.075f}, 0.85f, 0.65f, 0.05f, 0.0015f},  // clayey_soil
    {{0.25f, 0.19f, 0.13f}, 0.8f, 0.7f, 0.05f, 0.001f},      // lean_clay
    {{0.9f, 0.9f, 0.91f}, 0.9f, 0.98f, 0.03f, 0.0006f},      // snow
    {{0.085f, 0.06f, 0.04f}, 0.35f, 0.6f, 0.08f, 0.002f},    // mud
    {{0.125f, 0.12f, 0.115f}, 1.0f, 0.75f, 0.02f, 0.0012f},  // lunar
}};

int look_row(const SoilDescription& soil) {
  return static_cast<int>(std::find(kSoilKinds.begin(), kSoilKinds.end(), soil.kind) -
                          kSoilKinds.begin());
}

MaterialDescription material_of(const SoilDescription& soil, RenderDescription* out) {
  const SoilLook& look = kLooks[static_cast<size_t>(look_row(soil))];
  ProceduralDescription pattern = default_procedural(ProceduralKind::kNoise);
  pattern.color_a = look.color;
  pattern.color_b = look.color * look.tone;
  pattern.scale = look.grain;
  pattern.depth = look.height;
  pattern.roughness = look.roughness;
  MaterialDescription material;
  material.name = soil.name;
  material.base_color = {1, 1, 1};
  material.roughness = look.roughness;
  material.specular_weight = 0.3f;
  material.pattern = static_cast<int>(out->procedurals.size());
  out->procedurals.push_back(pattern);
  return material;
}

/// Height over the ground at which fallen snow is drawn: what is too thin to hide it lies under it
/// and is the whiteness that the weather gives the ground, so that a bed's border is no change of
/// colour. `depth`: of snow [m].
double seen_height(double depth) {
  constexpr double kThin = 0.025;  // [m]
  return depth - kThin * std::max(1 - depth / (4 * kThin), 0.0);
}
// Snow that is left in a print that goes down to the ground [m].
constexpr double kCrust = 0.003;

/// Vertices at the middles of cells, those of the outer cells moved out to the edges, and one more
/// all around that the sides go down to.
struct SoilMesh {
  explicit SoilMesh(const SoilDescription& of) : soil(of), nx(of.nx + 2), ny(of.ny + 2) {}
  const SoilDescription& soil;
  int nx, ny;

  static int cell_along(int i, int n) { return std::clamp(i - 1, 0, n - 1); }
  static double place_along(int i, int n, double low, double d) {
    return i <= 1 ? low : i >= n ? low + d * n : low + d * (i - 0.5);
  }
  template <class Visit>  // (x, y, z)
  void each_vertex(std::span<const float> tracks, double time, const Visit& visit) const {
    const double fallen = soil.growth * time;
    for (int j = 0; j < ny; ++j) {
      const double y = place_along(j, soil.ny, soil.low_y(), soil.dy);
      for (int i = 0; i < nx; ++i) {
        const auto cell =
            static_cast<size_t>(cell_along(j, soil.ny)) * static_cast<size_t>(soil.nx) +
            static_cast<size_t>(cell_along(i, soil.nx));
        const bool below = i == 0 || j == 0 || i == nx - 1 || j == ny - 1;
        const double depth = soil.depth_of(cell, fallen);
        const double ground = soil.rest_of(cell) + soil.share_of(cell) * fallen - depth;
        double height = soil.fallen ? seen_height(below ? 0 : depth) : below ? 0 : depth;
        if (!below && !tracks.empty()) {
          const auto here = static_cast<float>(soil.share_of(cell) * fallen);
          const double track = height + double{track_height(tracks[cell], here)};
          height = soil.fallen ? std::max(track, std::min(height, kCrust)) : track;
        }
        const double z = ground + height;
        visit(static_cast<float>(place_along(i, soil.nx, soil.low_x(), soil.dx)),
              static_cast<float>(y), static_cast<float>(z));
      }
    }
  }
};

TriangleMesh surface_of(const SoilDescription& soil) {
  const SoilMesh grid(soil);
  TriangleMesh mesh;
  grid.each_vertex({}, 0, [&](float x, float y, float z) { mesh.positions.push_back({x, y, z}); });
  add_grid_triangles(grid.nx, &mesh);
  return mesh;
}

}  // namespace

int soil_vertices(const SoilDescription& soil) { return (soil.nx + 2) * (soil.ny + 2); }

void append_soil_vertices(const SoilDescription& soil, std::span<const float> tracks, double time,
                          std::vector<float>* out) {
  SoilMesh(soil).each_vertex(
      tracks, time, [out](float x, float y, float z) { out->insert(out->end(), {x, y, z}); });
}

void author_soils(const std::vector<SoilDescription>& soils, int first_vertex, LabelTable* labels,
                  RenderDescription* out) {
  constexpr int kSoil = -5;  // a kind of thing that is no object of MuJoCo's
  for (size_t i = 0; i < soils.size(); ++i) {
    const SoilDescription& soil = soils[i];
    author_surface({soil.name, kSoil, static_cast<int>(i)}, material_of(soil, out),
                   surface_of(soil), first_vertex, labels, out);
    first_vertex += soil_vertices(soil);
  }
}

}  // namespace gloam

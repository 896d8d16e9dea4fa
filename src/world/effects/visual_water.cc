#include "world/effects/visual_water.h"

#include "world/materials/visual_surface.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

// Absorption of pure water at 620, 550 and 460 nm [1/m]: Pope and Fry 1997, table 3.
constexpr Vec3f kPureWater{0.2755f, 0.0565f, 0.0098f};
// And at 905 and 1550 nm [1/m], from imaginary indices of about 5e-7 and 1.2e-4, between the rows
// of Hale and Querry 1973.
constexpr std::array<float, 2> kInfrared{7, 1000};
constexpr float kIndex = 1.333f;  // at 589 nm and 20 °C (Hale and Querry 1973)

// A Secchi disk is lost at 1.7 over the diffuse attenuation (Poole and Atkins 1929). What that is
// beyond pure water's in green is taken as grey.
Vec3f absorption_of(double secchi_depth) {
  const float more = max(static_cast<float>(1.7 / secchi_depth) - kPureWater.y, 0.0f);
  return kPureWater + Vec3f{more, more, more};
}

// A microfacet distribution's alpha is the root of the mean square slope (Beckmann's; GGX with that
// alpha is taken for it), and OpenPBR's roughness the root of alpha.
float roughness_of(double mean_square_slope) {
  return static_cast<float>(std::sqrt(std::sqrt(mean_square_slope)));
}

MaterialDescription material_of(const WaterDescription& water) {
  MaterialDescription material;
  material.name = water.name;
  material.base_color = {1, 1, 1};
  material.roughness = roughness_of(water.short_slopes);
  material.ior = kIndex;
  material.transmission_weight = 1;
  material.transmission_depth = 1;
  const Vec3f k = absorption_of(water.clarity);
  material.transmission_color = {std::exp(-k.x), std::exp(-k.y), std::exp(-k.z)};
  material.infrared_absorption = kInfrared;
  return material;
}

TriangleMesh surface_of(const WaterDescription& water) {
  const WaterGrid& grid = water.mesh;
  TriangleMesh mesh;
  for (int j = 0; j <= grid.ny; ++j) {
    for (int i = 0; i <= grid.nx; ++i) {
      mesh.positions.push_back({static_cast<float>(water.low_x() + grid.dx * i),
                                static_cast<float>(water.low_y() + grid.dy * j),
                                static_cast<float>(water.level)});
    }
  }
  add_grid_triangles(grid.nx + 1, &mesh);
  return mesh;
}

}  // namespace

int water_vertices(const WaterDescription& water) {
  return (water.mesh.nx + 1) * (water.mesh.ny + 1);
}

void author_waters(const std::vector<WaterDescription>& waters, int first_vertex,
                   LabelTable* labels, RenderDescription* out) {
  constexpr int kWater = -4;  // a kind of thing that is no object of MuJoCo's
  for (size_t i = 0; i < waters.size(); ++i) {
    const WaterDescription& water = waters[i];
    author_surface({water.name, kWater, static_cast<int>(i)}, material_of(water), surface_of(water),
                   first_vertex, labels, out);
    first_vertex += water_vertices(water);
  }
}

}  // namespace gloam

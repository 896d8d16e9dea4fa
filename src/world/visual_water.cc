#include "world/visual_water.h"

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

MaterialDescription material_of(const WaterDescription& water) {
  MaterialDescription material;
  material.name = water.name;
  material.base_color = {1, 1, 1};
  material.roughness = 0;
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
  const auto row = static_cast<uint32_t>(grid.nx + 1);
  for (uint32_t j = 0; j < static_cast<uint32_t>(grid.ny); ++j) {
    for (uint32_t i = 0; i + 1 < row; ++i) {
      const uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
  }
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
    InstanceDescription instance;
    instance.shape = ShapeType::kDeformable;
    instance.mesh = static_cast<int>(out->deformables.size());
    instance.size = {1, 1, 1};
    instance.material = static_cast<int>(out->materials.size());
    instance.label = labels->label(0, water.name, kWater, static_cast<int>(i));
    instance.label.geom = water.name;
    instance.label.material = water.name;
    instance.label.part = static_cast<uint32_t>(out->instances.size()) + 1;
    out->materials.push_back(material_of(water));
    out->deformables.push_back({surface_of(water), first_vertex});
    out->instances.push_back(std::move(instance));
    first_vertex += water_vertices(water);
  }
}

}  // namespace gloam

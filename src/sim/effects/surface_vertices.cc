#include "sim/effects/surface_vertices.h"

#include "sim/effects/water/water_surface.h"
#include "world/effects/surface_layout.h"
#include "world/effects/visual_soil.h"
#include "world/effects/visual_water.h"
#include "world/world.h"

namespace gloam {
namespace {

void append_water_vertices(const WaterDescription& water, const HeightChange& ripples, double time,
                           std::vector<float>* heights, std::vector<float>* vertices) {
  heights->resize(static_cast<size_t>(water_vertices(water)));
  surface_heights(water, ripples, time, *heights);
  size_t n = 0;
  for (int row = 0; row <= water.mesh.ny; ++row) {
    for (int column = 0; column <= water.mesh.nx; ++column, ++n) {
      vertices->push_back(static_cast<float>(water.low_x() + water.mesh.dx * column));
      vertices->push_back(static_cast<float>(water.low_y() + water.mesh.dy * row));
      vertices->push_back(static_cast<float>(water.level) + (*heights)[n]);
    }
  }
}

}  // namespace

void append_surface_vertices(const CompiledWorld& world, std::span<const HeightChange> surfaces,
                             double time, std::vector<float>* scratch,
                             std::vector<float>* vertices) {
  for (size_t i = 0; i < world.waters.size(); ++i)
    append_water_vertices(world.waters[i], surfaces[water_surface(world, i)], time, scratch,
                          vertices);
  for (size_t i = 0; i < world.soils.size(); ++i) {
    const auto& tracks = surfaces[soil_surface(world, i)].field;
    append_soil_vertices(
        world.soils[i],
        tracks != nullptr ? std::span<const float>(tracks->height) : std::span<const float>{}, time,
        vertices);
  }
}

}  // namespace gloam

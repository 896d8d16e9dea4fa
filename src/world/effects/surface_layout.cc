#include "world/effects/surface_layout.h"

#include "world/effects/visual_water.h"
#include "world/shapes/deformable_layout.h"
#include "world/world.h"

namespace gloam {

size_t water_surface(const CompiledWorld&, size_t water) { return water; }

size_t soil_surface(const CompiledWorld& world, size_t soil) { return world.waters.size() + soil; }

size_t surface_count(const CompiledWorld& world) {
  return world.waters.size() + world.soils.size();
}

int first_water_vertex(const CompiledWorld& world) {
  return deformable_layout(*world.model).nvertex;
}

int first_soil_vertex(const CompiledWorld& world) {
  int first = first_water_vertex(world);
  for (const WaterDescription& water : world.waters) first += water_vertices(water);
  return first;
}

}  // namespace gloam

#include "sim/effects/effect_outputs.h"

#include "world/effects/surface_layout.h"
#include "world/world.h"

namespace gloam {

void EffectOutputs::fit(const CompiledWorld& world) {
  media.resize(world.gases.gases.size());
  surfaces.resize(surface_count(world));
  if (has_probe(world, "soil_work")) ground_work.assign(static_cast<size_t>(world.model->nbody), 0);
  loads.reserve(world.soils.size() * static_cast<size_t>(world.model->ngeom));
}

void EffectOutputs::clear() {
  for (FieldWindow& medium : media) medium = {};
  for (HeightChange& surface : surfaces) surface = {};
  loads.clear();
  snow_left.reset();
}

}  // namespace gloam

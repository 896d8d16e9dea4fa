#pragma once
// Plants and things on open country.

#include "places/place.h"
#include "places/terrain/landscape.h"

namespace gloam {

/// Posts and rails along the border, which robots cannot cross, gates across the road.
void add_fence(const Landscape& land, uint64_t seed, Workshop* shop, Place* place);
/// A barn of boards on each building site.
void add_barns(const Landscape& land, uint64_t seed, Workshop* shop, Place* place);
/// Boulders and rocks, some of them loose.
void add_rocks(const Landscape& land, const TerrainOptions& options, Place* place);
/// Trees and bushes, within the border and beyond it.
void add_trees(const Landscape& land, const TerrainOptions& options, Place* place);
/// Patches of blades, within the border and some way beyond.
void add_grass(const Landscape& land, const TerrainOptions& options, Workshop* shop, Place* place);

/// Pebbles along the road and the shore, reeds.
void add_litter(const Landscape& land, const TerrainOptions& options, Workshop* shop, Place* place);

struct BladeOptions {
  double high = 0.2, square = 1;  ///< the highest, side of the square that is theirs [m]
  int count = 1000;
  double half_width = 0.0028;  ///< about [m]
};
/// Blades that bend outwards, their roots a little below z = 0.
Solid blades(const BladeOptions& options, Dice* dice);

/// A thing of the catalogue.
int make(Place* place, const char* kind, uint64_t seed, Vec3 size);

/// Upright along the unit normal, turned about it [rad].
Quat leaning(Vec3f n, double turned);
/// Stands on the ground as it leans there, turned about its normal [rad].
Pose on_ground(const Landscape& land, double x, double y, double turned);

}  // namespace gloam

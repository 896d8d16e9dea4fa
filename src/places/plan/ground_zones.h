#pragma once
// Visible ground of open country: its triangles, exactly those that are walked on, cut into zones
// along ragged borders, and the country around it.

#include "places/place.h"
#include "places/terrain/landscape.h"

namespace gloam {

/// The ground under the area, its samples `step` apart or closer.
HeightField sample_landscape(const Landscape& land, const Rect& area, double step);

/// Height of the field's triangles at a place within it [m].
double ground_height(const HeightField& field, double x, double y);

/// Draws meadow, road, shore, bare earth and rock on the field's triangulation.
void show_ground(const Landscape& land, const HeightField& field, Workshop* shop, Place* place);

/// Draws what lies beyond the field, to the hills on the horizon.
void show_country(const Landscape& land, const HeightField& field, Workshop* shop, Place* place);
void show_road_beyond(const Landscape& land, Workshop* shop, Place* place);

/// As sheet() of geometry/solid.h, turned so that it is seen from above.
TriangleMesh sheet_facing_up(const Path& points, int columns);

}  // namespace gloam

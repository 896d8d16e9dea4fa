#pragma once
// Measures of light from far away.

#include "world/render_description.h"

namespace gloam {

/// Illuminance of a surface that faces the unit direction n in the map's own frame (not turned), by
/// all of the map above it [lx].
float illuminance(const EnvironmentDescription& environment, Vec3f n);

/// The most of the sides +X, -X, +Y, -Y and up [lx].
float brightest_side(const EnvironmentDescription& environment);

}  // namespace gloam

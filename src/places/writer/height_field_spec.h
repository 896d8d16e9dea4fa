#pragma once
// A height field as MuJoCo knows it.

#include <mujoco/mujoco.h>

#include <string>

#include "geometry/height_field_parts.h"

namespace gloam {

/// Adds the field and its geom, both of that name, to the world body. Returns the geom; the name is
/// the caller's to check.
mjsGeom* add_height_field(const std::string& name, const HeightField& field, mjSpec* spec);

}  // namespace gloam

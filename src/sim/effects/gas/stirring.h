#pragma once
// What rotors do to air.

#include "sim/effects/gas/gas_solver.h"

namespace gloam::gas {

/// Half the thickness of the layer of air that a rotor's thrust is given to [voxels].
inline constexpr float kDiscReach = 1;

/// Radius of the disc that a grid can hold [m].
float disc_radius(const GasRotor& rotor, float voxel);
/// Of air far behind a hovering rotor, by momentum theory [m/s].
float far_wake_speed(const GasRotor& rotor, float voxel, float ambient_density);

}  // namespace gloam::gas

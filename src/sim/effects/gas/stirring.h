#pragma once
// Effect of rotors on air.

#include "sim/effects/gas/gas_solver.h"

namespace gloam::gas {

/// Half the thickness of the layer of air that a rotor's thrust is given to, and the width of its
/// edge [voxels]. Thinner and sharper ones make shear that the grid does not carry: with 1 and 1 a
/// disc of two voxels' radius gives a wake of twice its thrust, with these one of 1.1 times it.
inline constexpr float kDiscReach = 2, kDiscEdge = 3;

/// Radius of the disc that a grid can hold [m].
float disc_radius(const GasRotor& rotor, float voxel);
/// Speed of air far behind a hovering rotor, by momentum theory [m/s].
float far_wake_speed(const GasRotor& rotor, float voxel, float ambient_density);

}  // namespace gloam::gas

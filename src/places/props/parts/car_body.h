#pragma once
// The parts of a car that its family is made of.

#include "places/props/parts/hardware.h"
#include "places/vehicles.h"

namespace gloam {

inline constexpr float kCarSide = kCarSize.width / 2, kCarBelt = 0.94f;  // [m]
inline constexpr float kCarUnder = 0.19f;                                // [m]

/// Below the windows, with its wheel arches.
Solid car_shell();
/// Windows, roof, pillars, mirrors, and what is seen through the windows.
void add_car_cabin(PropPart* b, Workshop* shop, const std::string& paint, const std::string& black);

}  // namespace gloam

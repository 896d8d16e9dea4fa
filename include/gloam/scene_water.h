#pragma once
// Ponds, pools and basins of a scene file: [[water]]. Part of gloam/scene.h; docs/water.md has the
// models and their sources.

#include <array>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[water]]: a box of water with a surface that waves move. It carries and drags bodies.
struct WaterOptions {
  std::string name = {};                ///< unique
  Vec3 position = {};                   ///< of the middle of its surface at rest [m]
  std::array<double, 2> size = {4, 4};  ///< along x and y [m]
  double depth = 1;                     ///< [m]
  double wave_height = 0;   ///< significant height of waves: mean of the highest third [m]
  double wave_period = 2;   ///< of the strongest waves [s]
  double wave_to = 0;       ///< direction they run to, from +x to +y [deg]
  double spread = 30;       ///< standard deviation of their directions [deg]
  double density = 998;     ///< [kg/m³]
  double viscosity = 1e-3;  ///< dynamic [Pa s]
  Vec3 current = {};        ///< [m/s]
  double clarity = 8;       ///< depth at which a white disk is lost from sight (Secchi) [m]
  bool ripples = true;      ///< bodies that cross the surface make waves
  SourceLoc loc = {};
};

}  // namespace gloam

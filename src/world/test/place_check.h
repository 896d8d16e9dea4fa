#pragma once
// What must hold of a generated place, checked on the compiled model alone, by MuJoCo's own
// collision detection: nothing here knows how the place was made.

#include <string>
#include <vector>

#include "world/world.h"

namespace gloam {

/// A robot for check_place: an upright cylinder that floats, MJCF.
std::string probe_model(double radius);

struct PlaceReport {
  double deepest_contact = 0;  ///< at t = 0 [m]
  std::string deepest;         ///< between what
  double furthest = 0;         ///< that anything moves in 2 s [m]
  std::string furthest_body;
  double most_turned = 0;  ///< angle about any axis by which anything turns in 2 s [rad]
  std::string most_turned_body;
  std::vector<std::string> blocked_doors;  ///< that cannot swing through their range
  std::vector<std::string> unreached;      ///< regions
  double reached_area = 0;                 ///< by the probe's axis [m²]
};

/// `world` = the place with probe_model() as its robot "probe". The probe walks from the origin,
/// with all doors open, over steps of at most 0.2 m, on a grid of `cell` [m]. Things have 2 s to
/// come to rest.
PlaceReport check_place(const CompiledWorld& world, double cell);

}  // namespace gloam

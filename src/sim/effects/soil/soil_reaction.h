#pragma once
// What beds of soil do to colliders. MuJoCo's contacts have none of it.

namespace gloam {

/// On one geom, of one bed, in the last step.
struct SoilReaction {
  int geom = -1, body = -1;
  double p[3] = {};       ///< the middle of the load, world [m]
  double normal[3] = {};  ///< along which the ground presses, world, unit
  double force[3] = {};   ///< on the geom, world [N]
};

}  // namespace gloam

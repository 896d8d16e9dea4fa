#pragma once
// Loads between things and the ground that are not among MuJoCo's contacts.

namespace gloam {

/// Force of soft ground ([[soil]]) on one geom, in the last step.
struct ContactLoad {
  int geom = -1, body = -1;  ///< ids of MuJoCo
  double p[3] = {};          ///< middle of the load, world [m]
  double normal[3] = {};     ///< along which the ground presses, world, unit
  double force[3] = {};      ///< on the geom, world [N]
  double depth = 0;          ///< sinkage of its deepest cell below the undisturbed surface [m]
};

}  // namespace gloam

#pragma once
// Loads between geoms and the ground that are not MuJoCo contacts.

namespace gloam {

/// Force of soft ground ([[soil]]) on one geom, in the last step.
struct ContactLoad {
  int geom = -1, body = -1;  ///< MuJoCo ids
  double p[3] = {};          ///< middle of the load, world [m]
  double normal[3] = {};     ///< direction in which the ground presses, world, unit
  double force[3] = {};      ///< force on the geom, world [N]
  double depth = 0;          ///< sinkage of its deepest cell below the undisturbed surface [m]
};

}  // namespace gloam

#pragma once
// Touches of the ground that are no contacts of MuJoCo's.

#include "gloam/contact.h"

namespace gloam {

/// A foot of an agent that came down on the ground in the last step.
struct Footfall {
  int agent = -1;    ///< row of CompiledWorld::agents
  double p[3] = {};  ///< place of the foot, world [m]
  double mass = 0;   ///< mass of the agent [kg]
  double speed = 0;  ///< speed of the agent over the ground [m/s]
};

}  // namespace gloam

#pragma once
// What sources give, as the card is told.

#include "base/vec.h"

namespace gloam::gas {

/// What a source gives to each of its cells in a substep.
struct Gift {
  int cells = 0;                        ///< how many
  float heat = 0, smoke = 0, fuel = 0;  ///< of kHeat, kSmoke, kFuel
  bool blows = false;
  Vec3f velocity;  ///< [m/s]
};

}  // namespace gloam::gas

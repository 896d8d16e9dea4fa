#pragma once
// Amounts that sources give, as the card receives them.

#include <vector>

#include "base/vec.h"

namespace gloam::gas {

/// Amount that a source gives to each of its cells in a substep.
struct Gift {
  int cells = 0;                        ///< number of cells
  float heat = 0, smoke = 0, fuel = 0;  ///< gains of kHeat, kSmoke, kFuel
  bool blows = false;
  Vec3f velocity;  ///< [m/s]
};

/// Amounts that cells or faces of a field gain in a substep; each appears once.
struct Addition {
  int field = 0;  ///< as HostFields counts
  int count = 0;  ///< number of cells or faces
};

/// Additions, with the indices and values of all of them one after the other.
struct Additions {
  std::vector<Addition> list;
  std::vector<int> at;
  std::vector<float> values;
};

}  // namespace gloam::gas

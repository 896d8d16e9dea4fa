#pragma once
// Steel arches, rock bolts, a ventilation duct, pipes and cables of a mine.

#include "places/mine/rock.h"
#include "places/place.h"
#include "places/workshop.h"

namespace gloam {

/// Adds them to the place. duct_side: +1 = the duct hangs on the left and pipes run on the right.
void add_fittings(const MineOptions& options, const MineRock& rock, double duct_side,
                  Workshop* shop, Dice* dice, Place* place);

}  // namespace gloam

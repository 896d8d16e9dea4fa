#pragma once
// The ground around a house, with what is seen from its windows.

#include "places/place.h"
#include "places/plan/floor_plan.h"

namespace gloam {

void add_garden(const FloorPlan& plan, uint64_t seed, Workshop* shop, Place* place);

}  // namespace gloam

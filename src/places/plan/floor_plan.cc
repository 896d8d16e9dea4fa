#include "places/plan/floor_plan.h"

#include <algorithm>
#include <cmath>

namespace gloam {

double Rect::distance_to(double px, double py) const {
  const double dx = std::max({x0 - px, px - x1, 0.0}), dy = std::max({y0 - py, py - y1, 0.0});
  return std::hypot(dx, dy);
}

Side opposite(Side side) {
  switch (side) {
    case Side::kWest:
      return Side::kEast;
    case Side::kEast:
      return Side::kWest;
    case Side::kSouth:
      return Side::kNorth;
    default:
      return Side::kSouth;
  }
}

std::vector<Opening> FloorPlan::openings_of(int room, Side side) const {
  std::vector<Opening> list;
  for (const Opening& o : openings)
    if ((o.a == room && o.side == side) || (o.b == room && opposite(o.side) == side))
      list.push_back(o);
  return list;
}

}  // namespace gloam

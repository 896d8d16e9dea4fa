#pragma once
// Shell of rooms: walls with their openings, floors, ceilings, skirting, doors, windows, stairs,
// the outside and the roof.

#include <map>

#include "places/place.h"
#include "places/plan/floor_plan.h"

namespace gloam {

/// Surfaces of a room, by what a Workshop calls them.
struct RoomFinish {
  std::string floor, wall, ceiling;  ///< materials
  bool skirting = true;
};

struct ShellOptions {
  std::vector<RoomFinish> rooms;  ///< one for each room of the plan
  std::string facade = {};        ///< material; empty = none
  std::string doors = "open";     ///< inner doors at the start: open ajar closed
  bool ceilings = true;
  bool roof = true;
  uint64_t seed = 0;
};

constexpr double kFacade = 0.2;       ///< thickness of what is outside the inner walls [m]
constexpr double kGroundDrop = 0.15;  ///< the ground outside lies below the floor [m]

/// Adds the whole shell and a region for each room.
void build_shell(const FloorPlan& plan, const ShellOptions& options, Place* place);

/// A pose in the ground plan, turned so that the prop's +x is the side's outward direction.
Pose facing(Side side, double x, double y, double z);

// The units that fill openings (openings.cc): local +x leads through the wall into room b, or out.
Prop make_door(Workshop& shop, const Opening& opening, double wall, bool hinge_left, double angle);
Prop make_entrance(Workshop& shop, const Opening& opening, double wall);
Prop make_arch(Workshop& shop, const Opening& opening, double wall);
Prop make_window(Workshop& shop, const Opening& opening, double wall);
/// A half-turn stair that fills the well (stairs.cc), with balustrades; origin at the middle of
/// the well's open side on the lower floor, +x into the well.
Prop make_stairs(Workshop& shop, double width, double depth, double rise);
/// Gable roof over a rectangle, its eaves at z = 0 (roof.cc).
Prop make_roof(Workshop& shop, double width, double depth);

}  // namespace gloam

#pragma once
// Interiors of dwellings and offices: finishes and lamps.

#include "places/furnish/furnish.h"
#include "places/furnish/shell.h"

namespace gloam {

/// The taste of a home.
Style draw_style(Dice* dice);

/// Floor, walls and ceiling of a room of a home, by its kind.
RoomFinish finish_of(const PlanRoom& room, Workshop* shop);

/// A sky with a sun of moderate height from anywhere; without a roof one that shines into rooms.
SkyOptions draw_sky(Dice* dice, bool roof);

/// Options that places made of rooms have in common.
struct InteriorOptions {
  uint64_t seed = 1;
  FurnishOptions furnish;
  bool furnished = true, roof = true;
  bool garden = true;  ///< is there something outside its windows?
  double ev100 = 8;    ///< under a roof; without one it is the sun that lights the rooms
};
template <class Options>
InteriorOptions interior_of(const Options& o) {
  InteriorOptions interior{o.seed, {o.passage, o.clutter, o.loose}, true, o.roof};
  if constexpr (requires { o.furnished; }) interior.furnished = o.furnished;
  return interior;
}

/// Shell, garden, furniture of every room, sky and exposure.
void build_interior(const FloorPlan& plan, ShellOptions shell, const InteriorOptions& options,
                    Dice* dice, Workshop* shop, Place* place);

}  // namespace gloam

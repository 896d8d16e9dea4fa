#pragma once
// What the insides of dwellings and offices share: how they are finished and lit.

#include "scene/environment/shell.h"

namespace gloam {

/// The taste of a home.
Style draw_style(Dice* dice);

/// Floor, walls and ceiling of a room of a home, by its kind.
RoomFinish finish_of(const PlanRoom& room, Workshop* shop);

/// A sky with a sun of moderate height from anywhere; without a roof one that shines into rooms.
SkyOptions draw_sky(Dice* dice, bool roof);

}  // namespace gloam

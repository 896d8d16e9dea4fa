#pragma once
// A clear sky whose sun goes on as the simulation runs: a pure function of time.

#include "world/sky/atmosphere.h"
#include "world/sky/sun_position.h"

namespace gloam {

struct DayCycle {
  CivilTime start;  ///< at time 0
  GeoPosition place;
  double speed = 1;       ///< speed of the clock [s/s]
  double north = 0;       ///< angle of true north from +Y, counter-clockwise [rad]
  AtmosphereOptions air;  ///< without its sun
};

/// Unit, towards the sun as seen through the air, in the world; `time` [s].
Vec3f to_sun_at(const DayCycle& day, double time);

/// Direction in the world of one with X east, Y north; `north` as in DayCycle.
Vec3f turned_north(Vec3f d, double north);

/// Heights of the sun [rad] for which skies are made: a quarter of a degree apart from the end of
/// astronomical twilight to 6 degrees above the horizon, where a sky's light halves within a
/// degree, then one degree up to the zenith.
int sky_count();
double sky_elevation(int row);
/// Row of an elevation, with fractions; within the first and the last.
double sky_row(double elevation);

/// Sky of the day with the sun at sky_elevation(row) over +X.
SkyLight sky_of_row(const DayCycle& day, int row);

}  // namespace gloam

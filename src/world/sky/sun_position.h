#pragma once
// Position of the sun by date, time and place.
//
// Solar coordinates and sidereal time after Meeus 1998, "Astronomical Algorithms", chapters 12, 22
// and 25 (lower accuracy), with parallax; refraction after Saemundsson 1986 down to -0.575 degrees
// and NOAA's continuation below. Against the solar position algorithm of Reda and Andreas 2004
// (0.0003 degrees): within 0.01 degrees without refraction, 0.02 with it at standard pressure. Real
// refraction at the horizon varies by tenths of a degree.

#include "base/vec.h"
#include "gloam/result.h"

namespace gloam {

/// Gregorian calendar, local clock.
struct CivilTime {
  int year = 2000, month = 1, day = 1;  ///< 1900..2100, 1..12, 1..the month's last
  int hour = 12, minute = 0;            ///< 0..23, 0..59
  double second = 0;                    ///< 0 <= second < 60
  double utc_offset = 0;  ///< offset of the clock from UTC, east positive [h], -14..14
};

struct GeoPosition {
  double latitude = 0;   ///< north positive [degrees], -90..90
  double longitude = 0;  ///< east positive [degrees], -180..180
};

struct SunPosition {
  double azimuth = 0;    ///< clockwise from north [rad], 0..2 pi
  double elevation = 0;  ///< height of the centre above the horizon, as seen through the air [rad]
  double true_elevation = 0;  ///< the same without refraction [rad]
  double distance = 1;        ///< [au]
  Vec3f to_sun;               ///< unit, towards the seen sun: X east, Y north, Z up
};

/// `later` [s] than `time`. Errors: a field outside of its range; the message names it.
Result<SunPosition> sun_position(const CivilTime& time, const GeoPosition& place, double later = 0);

}  // namespace gloam

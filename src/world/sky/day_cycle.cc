#include "world/sky/day_cycle.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/check.h"

namespace gloam {
namespace {

constexpr double kLowest = -18, kTwilightEnds = 6, kHighest = 90;  // [deg]
constexpr int kRowsPerDegree = 4;                                  // up to kTwilightEnds
constexpr int kFirstOfDay = static_cast<int>((kTwilightEnds - kLowest) * kRowsPerDegree);

}  // namespace

Vec3f to_sun_at(const DayCycle& day, double time) {
  const Result<SunPosition> sun = sun_position(day.start, day.place, day.speed * time);
  GLOAM_CHECK(sun.ok(), "the start of a day must be valid");
  return turned_north(sun->to_sun, day.north);
}

Vec3f turned_north(Vec3f d, double north) {
  const auto c = static_cast<float>(std::cos(north)), s = static_cast<float>(std::sin(north));
  return normalize(Vec3f{c * d.x - s * d.y, s * d.x + c * d.y, d.z});
}

int sky_count() { return kFirstOfDay + static_cast<int>(kHighest - kTwilightEnds) + 1; }

double sky_elevation(int row) {
  const double degrees = row < kFirstOfDay ? kLowest + static_cast<double>(row) / kRowsPerDegree
                                           : kTwilightEnds + (row - kFirstOfDay);
  return degrees * kDegree;
}

double sky_row(double elevation) {
  const double degrees = std::clamp(elevation / kDegree, kLowest, kHighest);
  return degrees < kTwilightEnds ? (degrees - kLowest) * kRowsPerDegree
                                 : kFirstOfDay + (degrees - kTwilightEnds);
}

SkyLight sky_of_row(const DayCycle& day, int row) {
  AtmosphereOptions air = day.air;
  const double elevation = sky_elevation(row);
  air.to_sun = {static_cast<float>(std::cos(elevation)), 0,
                static_cast<float>(std::sin(elevation))};
  Result<SkyLight> sky = make_sky(air);
  GLOAM_CHECK(sky.ok(), "the air of a day must be valid");
  return std::move(sky).value();
}

}  // namespace gloam

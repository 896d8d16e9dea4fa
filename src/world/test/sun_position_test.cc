// The sun's place against an almanac.

#include "world/sky/sun_position.h"
#include "base/angle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gloam {
namespace {

struct Reference {
  const char* name;
  CivilTime time;
  GeoPosition place;
  double azimuth, true_elevation, elevation;  // [degrees]
};

// The solar position algorithm of Reda and Andreas 2004 at sea level, 1010 hPa and 10 °C, as pvlib
// computes it; PyEphem (VSOP87) agrees within 0.0005 degrees of arc.
const Reference kReferences[] = {
    {"Golden", {2003, 10, 17, 12, 30, 30, -7}, {39.742476, -105.1786}, 194.3403, 39.8721, 39.8922},
    {"Greenwich", {2024, 6, 20, 12, 0, 0, 0}, {51.4779, -0.0015}, 179.1649, 61.9568, 61.9658},
    {"Singapore", {2024, 3, 20, 13, 10, 0, 8}, {1.3521, 103.8198}, 158.1477, 88.5799, 88.5803},
    {"Sydney", {2023, 12, 22, 9, 0, 0, 11}, {-33.8688, 151.2093}, 94.5242, 38.4371, 38.4583},
    {"Cape Town", {2010, 6, 21, 16, 45, 0, 2}, {-33.9249, 18.4241}, 306.9083, 9.6424, 9.7356},
    {"midnight sun", {2025, 6, 21, 0, 30, 0, 2}, {69.6492, 18.9553}, 356.3450, 3.1292, 3.3512},
    {"polar night", {2025, 12, 21, 11, 45, 0, 1}, {69.6492, 18.9553}, 180.6117, -3.0910, -3.0910},
    {"South Pole", {2019, 12, 21, 0, 0, 0, 0}, {-90, 0}, 179.4146, 23.4283, 23.4668},
    {"McMurdo", {1999, 1, 15, 23, 20, 0, 13}, {-77.85, 166.67}, 218.3503, 11.7695, 11.8469},
    {"Quito", {2000, 9, 22, 6, 20, 0, -5}, {-0.1807, -78.4678}, 89.8897, 3.3843, 3.5957},
    {"leap day", {2048, 2, 29, 17, 30, 0, 9}, {35.6762, 139.6503}, 260.3268, 0.3195, 0.7587},
    {"Honolulu", {1955, 7, 16, 12, 28, 0, -10}, {21.3069, -157.8583}, 87.5811, 87.8215, 87.8221},
};

SunPosition sun_of(const CivilTime& time, const GeoPosition& place) {
  const Result<SunPosition> sun = sun_position(time, place);
  EXPECT_TRUE(sun.ok()) << sun.error().to_string();
  return sun.ok() ? *sun : SunPosition{};
}

/// [degrees] between directions given by azimuth and elevation [rad].
double arc(double azimuth_a, double elevation_a, double azimuth_b, double elevation_b) {
  const double h = std::pow(std::sin((elevation_a - elevation_b) / 2), 2) +
                   std::cos(elevation_a) * std::cos(elevation_b) *
                       std::pow(std::sin((azimuth_a - azimuth_b) / 2), 2);
  return 2 * std::asin(std::sqrt(h)) / kDegree;
}

TEST(SunPosition, AgreesWithTheAlmanac) {
  double worst = 0;
  for (const Reference& r : kReferences) {
    const SunPosition sun = sun_of(r.time, r.place);
    const double gap =
        arc(sun.azimuth, sun.true_elevation, r.azimuth * kDegree, r.true_elevation * kDegree);
    worst = std::max(worst, gap);
    EXPECT_LT(gap, 0.01) << r.name;
    // The reference has no refraction once the sun is below the horizon.
    if (r.elevation > 0) {
      EXPECT_NEAR(sun.elevation / kDegree, r.elevation, 0.02) << r.name;
    }
    EXPECT_NEAR(sun.to_sun.x, std::cos(sun.elevation) * std::sin(sun.azimuth), 1e-6) << r.name;
    EXPECT_NEAR(sun.to_sun.z, std::sin(sun.elevation), 1e-6) << r.name;
    EXPECT_NEAR(length(sun.to_sun), 1, 1e-6) << r.name;
  }
  RecordProperty("worst_degrees", std::to_string(worst));
}

TEST(SunPosition, EastInTheMorningNorthAtNoonInTheSouth) {
  const SunPosition morning = sun_of({2024, 3, 20, 7, 0, 0, 0}, {51.5, 0});
  EXPECT_GT(morning.to_sun.x, 0.9f);
  const SunPosition north = sun_of({2024, 6, 21, 12, 0, 0, 0}, {51.5, 0});
  EXPECT_LT(north.to_sun.y, -0.4f);
  const SunPosition south = sun_of({2024, 6, 21, 12, 0, 0, 0}, {-35, 0});
  EXPECT_GT(south.to_sun.y, 0.8f);
}

TEST(SunPosition, DistanceFollowsTheOrbit) {
  // Perihelion 2025-01-04 13:28 UTC at 0.98333 au, aphelion 2025-07-03 19:55 UTC at 1.01664 au.
  EXPECT_NEAR(sun_of({2025, 1, 4, 13, 28, 0, 0}, {}).distance, 0.98333, 1e-4);
  EXPECT_NEAR(sun_of({2025, 7, 3, 19, 55, 0, 0}, {}).distance, 1.01664, 1e-4);
}

TEST(SunPosition, OffsetOfTheClockAndTheDayThatItCrosses) {
  const SunPosition utc = sun_of({2024, 12, 31, 23, 30, 0, 0}, {35, 139});
  const SunPosition local = sun_of({2025, 1, 1, 8, 30, 0, 9}, {35, 139});
  EXPECT_NEAR(utc.azimuth, local.azimuth, 1e-9);
  EXPECT_NEAR(utc.elevation, local.elevation, 1e-9);
  // Across February of a century that is no leap year, and of one that is.
  for (const int year : {1900, 2000}) {
    const CivilTime last{year, 2, year == 2000 ? 29 : 28, 23, 59, 59.5, 0};
    const SunPosition before = sun_of(last, {10, 20});
    const SunPosition after = sun_of({year, 3, 1, 0, 0, 0.5, 0}, {10, 20});
    EXPECT_LT(arc(before.azimuth, before.true_elevation, after.azimuth, after.true_elevation),
              0.005);
  }
}

TEST(SunPosition, MovesWithoutJumpsThroughSunset) {
  double before = 0;
  for (int second = 0; second < 3 * 3600; second += 20) {
    const SunPosition sun =
        sun_of({2024, 9, 22, 17 + second / 3600, second / 60 % 60, second % 60 * 1.0, 0}, {40, 0});
    if (second > 0) {
      EXPECT_LT(sun.elevation, before) << second;
      EXPECT_GT(sun.elevation, before - 0.15 * kDegree) << second;
    }
    EXPECT_GE(sun.elevation, sun.true_elevation);
    before = sun.elevation;
  }
}

TEST(SunPosition, WrongFieldsAreNamed) {
  const auto message = [](const CivilTime& time, const GeoPosition& place) {
    const Result<SunPosition> sun = sun_position(time, place);
    return sun.ok() ? std::string() : sun.error().to_string();
  };
  using testing::HasSubstr;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({2023, 2, 29}, {}), HasSubstr("day 29 is outside of 1..28 of that month"));
  EXPECT_EQ(message({2024, 2, 29}, {}), "");
  EXPECT_THAT(message({1066, 10, 14}, {}), HasSubstr("year 1066"));
  EXPECT_THAT(message({2024, 13, 1}, {}), HasSubstr("month 13"));
  EXPECT_THAT(message({2024, 1, 1, 24}, {}), HasSubstr("hour 24"));
  EXPECT_THAT(message({2024, 1, 1, 12, 60}, {}), HasSubstr("minute 60"));
  EXPECT_THAT(message({2024, 1, 1, 12, 0, 60}, {}), HasSubstr("second 60"));
  EXPECT_THAT(message({2024, 1, 1, 12, 0, nan}, {}), HasSubstr("second nan"));
  EXPECT_THAT(message({2024, 1, 1, 12, 0, 0, 15}, {}), HasSubstr("UTC offset 15"));
  EXPECT_THAT(message({}, {91, 0}), HasSubstr("latitude 91"));
  EXPECT_THAT(message({}, {nan, 0}), HasSubstr("latitude nan"));
  EXPECT_THAT(message({}, {0, 181}), HasSubstr("longitude 181"));
}

}  // namespace
}  // namespace gloam

#include "world/sky/sun_position.h"

#include <fmt/format.h>

#include <cmath>

#include "base/angle.h"

namespace gloam {
namespace {

/// Terrestrial minus universal time [s]: 64 to 70 from 2000 to 2030; the sun moves 0.001 degrees in
/// 90 s.
constexpr double kDeltaT = 69;

int days_in(int year, int month) {
  constexpr int kDays[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return month == 2 && leap ? 29 : kDays[month - 1];
}

Error field_error(const char* field, double value, double low, double high, const char* unit) {
  return {ErrorKind::kInput,
          fmt::format("{} {} is outside of {}..{}{}", field, value, low, high, unit)};
}

Status check(const CivilTime& t, const GeoPosition& place) {
  struct Field {
    const char* name;
    double value, low, high;
    const char* unit;
  };
  const Field fields[] = {{"year", 1.0 * t.year, 1900, 2100, ""},
                          {"month", 1.0 * t.month, 1, 12, ""},
                          {"hour", 1.0 * t.hour, 0, 23, ""},
                          {"minute", 1.0 * t.minute, 0, 59, ""},
                          {"UTC offset", t.utc_offset, -14, 14, " h"},
                          {"latitude", place.latitude, -90, 90, " degrees"},
                          {"longitude", place.longitude, -180, 180, " degrees"}};
  for (const Field& f : fields) {
    if (!(f.value >= f.low && f.value <= f.high)) {
      return field_error(f.name, f.value, f.low, f.high, f.unit);
    }
  }
  const int last = days_in(t.year, t.month);
  if (t.day < 1 || t.day > last) return field_error("day", t.day, 1, last, " of that month");
  if (!(t.second >= 0 && t.second < 60)) {
    return Error{ErrorKind::kInput,
                 fmt::format("second {} is outside of 0..60, 60 exclusive", t.second)};
  }
  return {};
}

/// Days of universal time since 2000-01-01 12:00.
double days_since_2000(const CivilTime& t) {
  // Days before the first of March of the year, months counted from there.
  const int year = t.month > 2 ? t.year : t.year - 1,
            month = t.month > 2 ? t.month - 3 : t.month + 9;
  const int day = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + t.day;
  constexpr int kDay2000 = 365 * 1999 + 1999 / 4 - 1999 / 100 + 1999 / 400 + (153 * 10 + 2) / 5 + 1;
  const double hours = t.hour + t.minute / 60.0 + t.second / 3600 - t.utc_offset;
  return day - kDay2000 + (hours - 12) / 24;
}

/// Lift by the air at 1010 hPa and 10 °C [rad] of an object at the true `elevation` [rad].
double refraction(double elevation) {
  const double h = elevation / kDegree;
  const double minutes = h > -0.575 ? 1.02 / std::tan((h + 10.3 / (h + 5.11)) * kDegree)
                                    : -20.774 / 60 / std::tan(elevation);
  // It is a thousandth of a minute below zero at the zenith, and without meaning far below ground.
  return h < -80 ? 0 : std::fmax(minutes, 0.0) / 60 * kDegree;
}

}  // namespace

Result<SunPosition> sun_position(const CivilTime& time, const GeoPosition& place, double later) {
  GLOAM_TRY_STATUS(check(time, place));
  const double days = days_since_2000(time) + later / 86400;
  const double t = (days + kDeltaT / 86400) / 36525;  // Julian centuries of terrestrial time

  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * kDegree;
  const double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
  const double center = (1.914602 - t * (0.004817 + t * 0.000014)) * std::sin(anomaly) +
                        (0.019993 - t * 0.000101) * std::sin(2 * anomaly) +
                        0.000289 * std::sin(3 * anomaly);
  const double node = (125.04 - 1934.136 * t) * kDegree;
  const double nutation = -0.00478 * std::sin(node);
  const double longitude = (mean_longitude + center - 0.00569 + nutation) * kDegree;
  const double obliquity =
      (23.4392911 - t * (0.0130042 + t * 1.64e-7) + 0.00256 * std::cos(node)) * kDegree;

  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double sidereal = (280.46061837 + 360.98564736629 * days + 0.000387933 * t * t +
                           nutation * std::cos(obliquity) + place.longitude) *
                          kDegree;

  SunPosition sun;
  sun.distance = 1.000001018 * (1 - eccentricity * eccentricity) /
                 (1 + eccentricity * std::cos(anomaly + center * kDegree));
  const double hour_angle = sidereal - right_ascension, latitude = place.latitude * kDegree;
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north = std::cos(latitude) * std::sin(declination) -
                       std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double up = std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  // From the centre of the earth; the place is a radius nearer to its zenith.
  const double geocentric = std::atan2(up, std::hypot(east, north));
  sun.true_elevation = geocentric - 8.794 / 3600 * kDegree / sun.distance * std::cos(geocentric);
  sun.elevation = sun.true_elevation + refraction(sun.true_elevation);
  sun.azimuth = std::atan2(east, north);
  if (sun.azimuth < 0) sun.azimuth += 2 * M_PI;
  const double level = std::cos(sun.elevation);
  sun.to_sun = {static_cast<float>(level * std::sin(sun.azimuth)),
                static_cast<float>(level * std::cos(sun.azimuth)),
                static_cast<float>(std::sin(sun.elevation))};
  return sun;
}

}  // namespace gloam

#include "scene/randomize/drawn_numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>

namespace gloam {

Numbers numbers_of(double x) { return {x}; }
Numbers numbers_of(const Vec3& v) { return {v.x, v.y, v.z}; }
Numbers numbers_of(const std::array<double, 2>& v) { return {v[0], v[1]}; }
Numbers numbers_of(const Quat&) { return {0}; }
Numbers numbers_of(const ClockTime& t) { return {t.hour * 3600 + t.minute * 60 + t.second}; }
Numbers numbers_of(const CalendarDate& d) {
  const std::chrono::year_month_day date{std::chrono::year(d.year),
                                         std::chrono::month(static_cast<unsigned>(d.month)),
                                         std::chrono::day(static_cast<unsigned>(d.day))};
  return {static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count())};
}

std::string text_of(const Numbers& v, double) { return fmt::format("{}", v[0]); }
std::string text_of(const Numbers& v, const Vec3&) {
  return fmt::format("[{}]", fmt::join(v, ", "));
}
std::string text_of(const Numbers& v, const std::array<double, 2>&) { return text_of(v, Vec3{}); }
std::string text_of(const Numbers& v, const Quat& written) {
  const Quat& q = written;
  const double half = v[0] * M_PI / 360, c = std::cos(half), s = std::sin(half);
  return fmt::format("[{}, {}, {}, {}]", c * q.w - s * q.z, c * q.x - s * q.y, c * q.y + s * q.x,
                     c * q.z + s * q.w);
}
std::string text_of(const Numbers& v, const ClockTime&) {
  constexpr double kDay = 86400;
  const int64_t ms = std::llround((v[0] - kDay * std::floor(v[0] / kDay)) * 1000) % 86400000;
  return fmt::format("{:02}:{:02}:{:02}.{:03}", ms / 3600000, ms / 60000 % 60, ms / 1000 % 60,
                     ms % 1000);
}
std::string text_of(const Numbers& v, const CalendarDate&) {
  const std::chrono::year_month_day date{
      std::chrono::sys_days(std::chrono::days(std::llround(v[0])))};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace gloam

#pragma once
// Options as the numbers that are sampled for them.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

using Numbers = std::vector<double>;

/// Numbers by which a type is sampled. An orientation: the angle in degrees by which it is turned
/// about the vertical; a time of day: seconds; a date: days.
Numbers numbers_of(double x);
Numbers numbers_of(const Vec3& v);
Numbers numbers_of(const std::array<double, 2>& v);
Numbers numbers_of(const Quat&);
Numbers numbers_of(const ClockTime& t);
Numbers numbers_of(const CalendarDate& d);

/// As in a scene file; the second argument is what was written before.
std::string text_of(const Numbers& v, double);
std::string text_of(const Numbers& v, const Vec3&);
std::string text_of(const Numbers& v, const std::array<double, 2>&);
std::string text_of(const Numbers& v, const Quat& written);
std::string text_of(const Numbers& v, const ClockTime&);
std::string text_of(const Numbers& v, const CalendarDate&);

template <class T>
constexpr bool kIsInteger = std::is_integral_v<T> && !std::is_same_v<T, bool>;
template <class T>
constexpr bool kIsTime = std::is_same_v<T, ClockTime> || std::is_same_v<T, CalendarDate>;
template <class T>
constexpr bool kIsNumbers =
    kIsInteger<T> || std::is_same_v<T, double> || std::is_same_v<T, Vec3> ||
    std::is_same_v<T, Quat> || std::is_same_v<T, std::array<double, 2>> || kIsTime<T>;

/// An option as the numbers that are sampled for it.
template <class T>
Numbers written_of(const T& member) {
  if constexpr (kIsInteger<T>)
    return numbers_of(static_cast<double>(member));
  else
    return numbers_of(member);
}

/// A value as in a scene file; `member` is what was written before.
template <class T>
std::string value_text(const Numbers& v, const T& member) {
  if constexpr (kIsInteger<T>)
    return fmt::format("{:.0f}", std::round(v[0]));
  else
    return text_of(v, member);
}

/// A distribution and its parameters as they stand in the scene file.
struct Distribution {
  enum Kind { kUniform, kLogUniform, kNormal, kChoice } kind;
  const std::vector<TomlText>& values;
};
Distribution distribution_of(const RandomizeOptions& options);

}  // namespace gloam

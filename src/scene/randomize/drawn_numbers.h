#pragma once
// Options as the numbers that are drawn of them.

#include <string>
#include <type_traits>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

using Numbers = std::vector<double>;

/// How a type is drawn: as so many numbers. Of an orientation, the angle in degrees by which it is
/// turned about the vertical; of a time of day, seconds; of a date, days.
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

}  // namespace gloam

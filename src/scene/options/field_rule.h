#pragma once
// Rules for the value of one option of a scene file.

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "gloam/scene.h"
#include "gloam/text.h"

namespace gloam {

struct FieldRule {
  std::string_view unit = {};  ///< "" = none or text
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;                           ///< min and max themselves are not allowed
  bool required = false;                       ///< must stand in the file
  std::vector<std::string_view> choices = {};  ///< closed list of words; empty = any
  bool identifier = false;       ///< a name: not empty, no '/' and no control characters
  std::string_view not_of = {};  ///< type of its table that has no such option; "" = it has
  bool one_for_three = false;    ///< a vector may be written as one number
  bool may_be_empty = false;     ///< of a text with choices or a name: "" = not given
  std::string_view unless = {};  ///< required unless this key of its table is given
};

/// For FieldRule::choices.
inline std::vector<std::string_view> words(std::span<const std::string_view> list) {
  return {list.begin(), list.end()};
}
template <NamedEnum Enum>
std::vector<std::string_view> words() {
  std::vector<std::string_view> list;
  for (const auto& row : EnumTable<Enum>::kNames) list.emplace_back(row.name);
  return list;
}

inline const FieldRule kShare{.min = 0, .max = 1};

inline constexpr double kLongestTime = 1e9;    // [s] 30 years
inline constexpr double kLargestLength = 1e7;  // [m], northings of maps
inline constexpr double kLargestSpeed = 1e4;   // [m/s], [rad/s]
inline constexpr double kFastestRate = 1e6;    // [Hz]

}  // namespace gloam

#pragma once
// The list `topics` of a bridge's options: names and patterns; * stands for any text.

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace gloam::bridge {

inline bool fits_topic_pattern(std::string_view pattern, std::string_view name) {
  const size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == name;
  if (name.substr(0, star) != pattern.substr(0, star)) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (size_t from = star; from <= name.size(); ++from)
    if (fits_topic_pattern(rest, name.substr(from))) return true;
  return false;
}

/// An empty list offers all.
inline bool is_offered(const std::vector<std::string>& patterns, std::string_view name) {
  return patterns.empty() || std::ranges::any_of(patterns, [&](const std::string& pattern) {
           return fits_topic_pattern(pattern, name);
         });
}

}  // namespace gloam::bridge

#include "policy/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <re2/re2.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text.h"
#include "scene/toml/toml_reader.h"
#include "scene/toml/value_reader.h"

namespace gloam {
namespace {

/// Toml++ counts regions of written values from 1; values made from metadata have none.
SourceLoc place_of(const toml::node* node, const std::string& file) {
  return node != nullptr ? loc_of(*node, file) : SourceLoc{file, 0, 0};
}

}  // namespace

std::string joined(std::span<const std::string> names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void Settings::fail(const toml::node* node, std::string message, std::string hint) {
  if (status_.ok())
    status_ = Error{ErrorKind::kInput, std::move(message), place_of(node, file_), std::move(hint)};
}

void Settings::check_keys(const toml::table& table, std::span<const std::string_view> known,
                          std::string_view where) {
  for (const auto& [key, node] : table) {
    if (std::ranges::find(known, key.str()) != known.end()) continue;
    const std::vector<std::string> names(known.begin(), known.end());
    const std::string near = nearest_name(key.str(), names);
    return fail(
        &node, fmt::format("{} has no '{:.80}'", where, key.str()),
        near.empty() ? "one of: " + joined(names) : fmt::format("did you mean '{}'?", near));
  }
}

double Settings::number(const toml::node& node, const std::string& name, const NumberRule& rule) {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) {
    fail(&node, fmt::format("{} must be a number, not {}", name, type_name(node)));
    return 0;
  }
  const bool inside =
      rule.open ? *value > rule.min && *value < rule.max : *value >= rule.min && *value <= rule.max;
  if (std::isnan(*value) || (rule.finite && !std::isfinite(*value)))
    fail(&node, fmt::format("{} must be a finite number, not {:g}", name, *value));
  else if (!inside && std::isfinite(rule.max))
    fail(&node, fmt::format("{} is {:g}; it must be {} {:g} and {:g}", name, *value,
                            rule.open ? "between" : "in the range of", rule.min, rule.max));
  else if (!inside)
    fail(&node, fmt::format("{} is {:g}; it must be {} {:g}", name, *value,
                            rule.open ? "above" : "at least", rule.min));
  return ok() ? *value : 0;
}

double Settings::number(const toml::table& table, std::string_view key, double fallback,
                        const NumberRule& rule) {
  const toml::node* node = table.get(key);
  return node == nullptr ? fallback : number(*node, std::string(key), rule);
}

int Settings::whole(const toml::table& table, std::string_view key, int fallback, int min,
                    int max) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return fallback;
  const auto value = node->value_exact<int64_t>();
  if (value && *value >= min && *value <= max) return static_cast<int>(*value);
  fail(node, fmt::format("{} must be a whole number from {} to {}, not {:.60}", key, min, max,
                         toml_text(*node)));
  return fallback;
}

bool Settings::flag(const toml::table& table, std::string_view key, bool fallback) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return fallback;
  const auto value = node->value_exact<bool>();
  if (!value) fail(node, fmt::format("{} must be true or false, not {}", key, type_name(*node)));
  return value.value_or(fallback);
}

std::string Settings::text(const toml::table& table, std::string_view key, std::string fallback) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return fallback;
  const auto value = node->value_exact<std::string>();
  if (!value) fail(node, fmt::format("{} must be a text, not {}", key, type_name(*node)));
  return value.value_or(fallback);
}

size_t Settings::choice(const toml::table& table, std::string_view key,
                        std::span<const std::string_view> choices) {
  const std::string word = text(table, key, std::string(choices[0]));
  const auto found = std::ranges::find(choices, word);
  if (found != choices.end()) return static_cast<size_t>(found - choices.begin());
  fail(table.get(key),
       fmt::format("{} must be \"{}\", not \"{:.80}\"", key, fmt::join(choices, "\" or \""), word));
  return 0;
}

std::array<double, 2> Settings::range(const toml::node& node, const std::string& name) {
  const NumberRule any{.finite = false};
  if (node.is_number()) {
    const double most = std::abs(number(node, name, any));
    return {-most, most};
  }
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 2) {
    fail(&node, fmt::format("{} must be [low, high], not {:.60}", name, toml_text(node)));
    return {};
  }
  const std::array<double, 2> bounds{number((*array)[0], name, any),
                                     number((*array)[1], name, any)};
  if (ok() && bounds[0] > bounds[1])
    fail(&node, fmt::format("{}: low {:g} is above high {:g}", name, bounds[0], bounds[1]));
  return bounds;
}

std::vector<std::string> Settings::names(const toml::table& table, std::string_view key) {
  std::vector<std::string> found;
  const toml::node* node = table.get(key);
  if (node == nullptr) return found;
  const toml::array* array = node->as_array();
  std::set<std::string> known;
  for (size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const auto name = (*array)[i].value_exact<std::string>();
    if (!name) break;
    if (!known.insert(*name).second) fail(node, fmt::format("{} lists {} twice", key, *name));
    found.push_back(*name);
  }
  if (array == nullptr || found.size() != array->size())
    fail(node, fmt::format("{} must be a list of names", key));
  return found;
}

std::vector<double> Settings::numbers(const toml::node& node, const std::string& name) {
  if (node.as_array() == nullptr) return {number(node, name, {})};
  std::vector<double> values;
  for (const toml::node& one : *node.as_array()) values.push_back(number(one, name, {}));
  return values;
}

const toml::table* Settings::table(const toml::table& parent, std::string_view key) {
  const toml::node* node = parent.get(key);
  if (node != nullptr && !node->is_table())
    fail(node, fmt::format("{} must be a table, not {}", key, type_name(*node)));
  return node == nullptr ? nullptr : node->as_table();
}

std::vector<double> Settings::per_joint(const toml::node& node, std::span<const std::string> joints,
                                        const std::string& name, std::optional<double> fallback) {
  std::vector<double> values(joints.size());
  if (const toml::table* table = node.as_table()) return by_pattern(*table, joints, name, fallback);
  if (const toml::array* array = node.as_array()) {
    if (array->size() != joints.size())
      fail(&node, fmt::format("{} has {} numbers for {} joints of the policy", name, array->size(),
                              joints.size()));
    for (size_t i = 0; ok() && i < joints.size(); ++i)
      values[i] = number((*array)[i], fmt::format("{} of {}", name, joints[i]), {});
    return values;
  }
  std::ranges::fill(values, number(node, name, {}));
  return values;
}

std::vector<double> Settings::by_pattern(const toml::table& table,
                                         std::span<const std::string> joints,
                                         const std::string& name, std::optional<double> fallback) {
  std::vector<std::optional<double>> found(joints.size(), fallback);
  std::vector<int> lines(joints.size(), -1);  // toml++ sorts its keys; the source has their order
  for (const auto& [key, node] : table) {
    const double value = number(node, fmt::format("{}.{:.80}", name, key.str()), {});
    const RE2 pattern(std::string(key.str()), RE2::Quiet);
    if (!pattern.ok())
      fail(&node, fmt::format("{}: '{:.80}' is not a valid regular expression: {}", name, key.str(),
                              pattern.error()));
    bool matches = false;
    for (size_t i = 0; ok() && i < joints.size(); ++i) {
      if (!RE2::FullMatch(joints[i], pattern)) continue;
      matches = true;
      const auto at = key.source().begin;
      const int line = joints[i] == key.str()
                           ? std::numeric_limits<int>::max()
                           : static_cast<int>(at.line) * 4096 + static_cast<int>(at.column % 4096);
      if (line < lines[i]) continue;
      found[i] = value, lines[i] = line;
    }
    if (ok() && !matches)
      fail(&node, fmt::format("{}: '{:.80}' matches no joint", name, key.str()),
           "joints: " + joined(joints));
  }
  std::vector<std::string> missing;
  std::vector<double> values;
  for (size_t i = 0; i < joints.size(); ++i) {
    if (!found[i]) missing.push_back(joints[i]);
    values.push_back(found[i].value_or(0));
  }
  if (!missing.empty()) fail(&table, fmt::format("{} has no number for {}", name, joined(missing)));
  return values;
}

}  // namespace gloam

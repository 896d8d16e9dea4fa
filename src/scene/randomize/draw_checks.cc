#include "scene/randomize/draw_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/toml/calendar.h"
#include "scene/toml/toml_reader.h"

namespace gloam {

std::nullopt_t DrawChecks::fail(std::string message, std::string hint) {
  if (status_->ok())
    *status_ =
        Error{ErrorKind::kInput, fmt::format("[[randomize]] of '{}': {}", o_.option, message),
              o_.loc, std::move(hint)};
  return std::nullopt;
}

bool DrawChecks::begin_example(bool is_pattern) {
  if (!is_pattern && !checks_only_) return false;
  ++examples_;
  return true;
}

void DrawChecks::check_sizes(const std::string& path, size_t n,
                             std::initializer_list<size_t> given) {
  for (const size_t count : given)
    if (count != 1 && count != n) fail(fmt::format("'{}' has {} numbers, not {}", path, n, count));
}

void DrawChecks::check_order(const Numbers& a, const Numbers& b, bool round) {
  const Distribution::Kind kind = distribution_of(o_).kind;
  const bool is_range = kind == Distribution::kUniform || kind == Distribution::kLogUniform;
  for (size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const double x = a[a.size() == 1 ? 0 : i], y = b[b.size() == 1 ? 0 : i];
    if (kind == Distribution::kLogUniform && std::min(x, y) <= 0)
      fail("log_uniform requires numbers above 0");
    if (is_range && x > y && !round) fail("the first value is above the second");
    if (kind == Distribution::kNormal && y < 0) fail("the standard deviation is negative");
  }
}

bool DrawChecks::check_override_shape(const Numbers& a, const Numbers& b) {
  if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
    fail(fmt::format("one value has {} numbers, the other {}", a.size(), b.size()));
  else
    check_order(a, b, false);
  return status_->ok();
}

const toml::node* DrawChecks::parse_value(size_t index, toml::table* table) {
  const std::string& text = distribution_of(o_).values[index].text;
  Result<toml::table> parsed = parse_toml("v = " + text, o_.loc.file);
  if (parsed.ok()) *table = *std::move(parsed);
  const toml::node* node = table->get("v");
  if (node == nullptr) fail(fmt::format("'{}' is not a valid value", text));
  return node;
}

std::optional<Numbers> DrawChecks::parse_time(size_t index) {
  toml::table table;
  const toml::node* node = parse_value(index, &table);
  if (node == nullptr) return std::nullopt;
  if (const auto time = read_time(*node)) return numbers_of(*time);
  return fail(fmt::format("{} is not a time of day", distribution_of(o_).values[index].text),
              "write it as 14:30:00");
}

std::optional<Numbers> DrawChecks::parse_date(size_t index) {
  toml::table table;
  const toml::node* node = parse_value(index, &table);
  if (node == nullptr) return std::nullopt;
  if (const auto date = read_date(*node)) return numbers_of(*date);
  return fail(fmt::format("{} is not a date", distribution_of(o_).values[index].text),
              "write it as 2026-06-21");
}

std::optional<Numbers> DrawChecks::parse_numbers(size_t index) {
  toml::table table;
  const toml::node* node = parse_value(index, &table);
  if (node == nullptr) return std::nullopt;
  Numbers numbers;
  const auto take = [&](const toml::node& n) {
    const std::optional<double> x = n.value<double>();
    if (n.is_number() && x && std::isfinite(*x)) numbers.push_back(*x);
    return n.is_number() && x && std::isfinite(*x);
  };
  bool good = !node->is_array() && take(*node);
  if (const toml::array* array = node->as_array()) {
    good = !array->empty();
    for (const toml::node& n : *array) good = good && take(n);
  }
  if (good) return numbers;
  return fail(fmt::format("{} is neither a number nor an array of numbers",
                          distribution_of(o_).values[index].text));
}

}  // namespace gloam

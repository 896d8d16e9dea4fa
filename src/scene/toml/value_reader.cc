#include "scene/toml/value_reader.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>
#include <sstream>

#include "base/text.h"
#include "scene/toml/calendar.h"
#include "scene/toml/override_reader.h"
#include "scene/toml/toml_reader.h"

namespace gloam {

const char* type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a floating-point number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

std::string range_text(const FieldRule& rule) {
  const std::string unit = rule.unit.empty() ? "" : fmt::format(" {}", rule.unit);
  if (std::isfinite(rule.min) && std::isfinite(rule.max)) {
    return rule.open ? fmt::format("between {} and {}{}, exclusive", rule.min, rule.max, unit)
                     : fmt::format("from {} to {}{}", rule.min, rule.max, unit);
  }
  return fmt::format("a finite number{}", unit);
}

void ValueReader::fail(const toml::node& node, std::string message, std::string hint) {
  if (status_->ok())
    *status_ = Error{ErrorKind::kInput, std::move(message), loc_of(node, file_), std::move(hint)};
}

void ValueReader::wrong_type(const toml::node& node, const std::string& key,
                             std::string_view wanted) {
  fail(node, fmt::format("'{}' must be {}, not {}", key, wanted, type_name(node)));
}

void ValueReader::read(const toml::node& node, const std::string& key, std::string& out,
                       const FieldRule& rule) {
  const auto value = node.value_exact<std::string>();
  if (!value) return wrong_type(node, key, "a string");
  if (!check_text(node, key, *value, rule)) return;
  out = *value;
}

// Any value, as it stands.
std::string toml_text(const toml::node& node) {
  std::ostringstream text;
  if (const toml::table* table = node.as_table(); table != nullptr) {
    toml::table on_one_line = *table;  // as a value is written, not as a section
    on_one_line.is_inline(true);
    text << on_one_line;
  } else {
    node.visit([&](const auto& value) { text << value; });
  }
  return text.str();
}

void ValueReader::read(const toml::node& node, const std::string&, TomlText& out,
                       const FieldRule&) {
  out.text = toml_text(node);
}

bool ValueReader::check_text(const toml::node& node, const std::string& key,
                             const std::string& value, const FieldRule& rule) {
  const bool control = std::any_of(value.begin(), value.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
  if (control) {
    fail(node, fmt::format("'{}' contains a control character", key));
    return false;
  }
  if (rule.required && value.empty()) {
    fail(node, fmt::format("'{}' is empty", key));
    return false;
  }
  if (rule.may_be_empty && value.empty()) return true;
  if (rule.identifier && (value.empty() || value.find('/') != std::string::npos)) {
    fail(node, fmt::format("'{}' must be a name without '/', not '{}'", key, value));
    return false;
  }
  if (!rule.choices.empty() &&
      std::find(rule.choices.begin(), rule.choices.end(), value) == rule.choices.end()) {
    const std::vector<std::string> choices(rule.choices.begin(), rule.choices.end());
    fail(node, fmt::format("'{}' cannot be '{}'", key, value), suggest_name(value, choices));
    return false;
  }
  return true;
}

void ValueReader::read(const toml::node& node, const std::string& key, std::filesystem::path& out,
                       const FieldRule& rule) {
  std::string text;
  read(node, key, text, rule);
  if (status_->ok()) out = text;
}

void ValueReader::read(const toml::node& node, const std::string& key, bool& out,
                       const FieldRule&) {
  const auto value = node.value_exact<bool>();
  if (!value) return wrong_type(node, key, "true or false");
  out = *value;
}

void ValueReader::read(const toml::node& node, const std::string& key, double& out,
                       const FieldRule& rule) {
  double value = 0;
  if (const auto number = node.value_exact<double>()) {
    value = *number;
  } else if (const auto integer = node.value_exact<int64_t>()) {
    value = static_cast<double>(*integer);
  } else {
    return wrong_type(node, key, "a number");
  }
  if (!in_range(value, rule))
    return fail(node, fmt::format("'{}' is {}; it must be {}", key, value, range_text(rule)));
  out = value;
}

bool ValueReader::in_range(double value, const FieldRule& rule) {
  if (!std::isfinite(value)) return false;
  return rule.open ? value > rule.min && value < rule.max : value >= rule.min && value <= rule.max;
}

void ValueReader::read(const toml::node& node, const std::string& key, Rational& out,
                       const FieldRule& rule) {
  Rational value;
  if (const auto integer = node.value_exact<int64_t>()) {
    value = {*integer, 1};
  } else if (const auto number = node.value_exact<double>()) {
    if (!exact_rational(*number, &value)) {
      return fail(node, fmt::format("'{}' is {}, which is not an exact fraction", key, *number),
                  "write it as \"num/den\", e.g. \"30000/1001\"");
    }
  } else if (const auto text = node.value_exact<std::string>()) {
    const char* const end = text->data() + text->size();
    const auto num = std::from_chars(text->data(), end, value.num);
    bool good = num.ec == std::errc() && num.ptr != end && *num.ptr == '/';
    if (good) {
      const auto den = std::from_chars(num.ptr + 1, end, value.den);
      good = den.ec == std::errc() && den.ptr == end && value.den > 0;
    }
    if (!good) {
      return fail(node, fmt::format("'{}' is '{}', which is not a fraction", key, *text),
                  "write it as \"num/den\", e.g. \"30000/1001\"");
    }
    const int64_t divisor = std::gcd(value.num, value.den);
    if (divisor > 1) value = {value.num / divisor, value.den / divisor};
  } else {
    return wrong_type(node, key, "a number or a fraction \"num/den\"");
  }
  if (!in_range(value.value(), rule)) {
    return fail(node,
                fmt::format("'{}' is {}; it must be {}", key, value.value(), range_text(rule)));
  }
  out = value;
}

void ValueReader::read(const toml::node& node, const std::string& key, Vec3& out,
                       const FieldRule& rule) {
  double v[3] = {};
  if (rule.one_for_three && node.is_number()) {
    read(node, key, v[0], rule);
    if (status_->ok()) out = {v[0], v[0], v[0]};
    return;
  }
  if (read_numbers(node, key, v, rule)) out = {v[0], v[1], v[2]};
}

void ValueReader::read(const toml::node& node, const std::string& key, std::array<double, 2>& out,
                       const FieldRule& rule) {
  double v[2] = {};
  if (read_numbers(node, key, v, rule)) out = {v[0], v[1]};
}

void ValueReader::read(const toml::node& node, const std::string& key, CalendarDate& out,
                       const FieldRule&) {
  const auto date = read_date(node);
  if (!date) return fail(node, fmt::format("'{}' is not a date", key), "write it as 2026-06-21");
  out = *date;
}

void ValueReader::read(const toml::node& node, const std::string& key, ClockTime& out,
                       const FieldRule&) {
  const auto time = read_time(node);
  if (!time)
    return fail(node, fmt::format("'{}' is not a time of day", key), "write it as 14:30:00");
  out = *time;
}

double largest_of(const double (&v)[4]) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2]), std::abs(v[3])});
}

Quat unit_quaternion(const double (&wxyz)[4]) {
  const double largest = largest_of(wxyz);
  double v[4], norm = 0;
  for (int i = 0; i < 4; ++i) {
    v[i] = wxyz[i] / largest;  // squares of huge or tiny components would overflow or vanish
    norm += v[i] * v[i];
  }
  norm = std::sqrt(norm);
  return {v[0] / norm, v[1] / norm, v[2] / norm, v[3] / norm};
}

void ValueReader::read(const toml::node& node, const std::string& key, Quat& out,
                       const FieldRule& rule) {
  double v[4] = {};
  if (!read_numbers(node, key, v, rule)) return;
  if (!(largest_of(v) > 1e-12)) {
    return fail(node, fmt::format("'{}' is zero, which is not a rotation", key),
                "use a quaternion [w, x, y, z]; the identity is [1, 0, 0, 0]");
  }
  out = unit_quaternion(v);
}

void ValueReader::read(const toml::node& node, const std::string& key,
                       std::vector<OverrideOptions>& out, const FieldRule&) {
  const toml::table* table = node.as_table();
  if (table == nullptr) return wrong_type(node, key, "a table");
  const Status status = read_overrides(*table, file_, &out);
  if (status_->ok() && !status.ok()) *status_ = status.error();
}

}  // namespace gloam

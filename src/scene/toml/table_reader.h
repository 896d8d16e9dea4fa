#pragma once
// The visitor that fills one option struct from one TOML table. All in a header because it is a
// template over every struct of option_fields.h, for two users: whole files and single overrides.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "base/text.h"
#include "scene/options/option_fields.h"
#include "scene/toml/calendar.h"
#include "scene/toml/override_reader.h"
#include "scene/toml/toml_reader.h"

namespace gloam {

inline const char* type_name(const toml::node& node) {
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
      return "a number with a point";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

inline std::string range_text(const FieldRule& rule) {
  const std::string unit = rule.unit.empty() ? "" : fmt::format(" {}", rule.unit);
  if (std::isfinite(rule.min) && std::isfinite(rule.max)) {
    return rule.open ? fmt::format("between {} and {}{}, exclusive", rule.min, rule.max, unit)
                     : fmt::format("from {} to {}{}", rule.min, rule.max, unit);
  }
  return fmt::format("a finite number{}", unit);
}

inline double largest_of(const double (&v)[4]) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2]), std::abs(v[3])});
}

/// The rotation of a quaternion wxyz that is not zero.
inline Quat unit_quaternion(const double (&wxyz)[4]) {
  const double largest = largest_of(wxyz);
  double v[4], norm = 0;
  for (int i = 0; i < 4; ++i) {
    v[i] = wxyz[i] / largest;  // squares of huge or tiny components would overflow or vanish
    norm += v[i] * v[i];
  }
  norm = std::sqrt(norm);
  return {v[0] / norm, v[1] / norm, v[2] / norm, v[3] / norm};
}

class TableReader {
 public:
  TableReader(const toml::table& table, const std::string& file, std::string where, Status* status)
      : table_(table), file_(file), where_(std::move(where)), status_(status) {}

  /// One field of the struct that this table fills.
  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule& rule) {
    known_.emplace_back(key);
    if (!status_->ok()) return;
    const toml::node* node = table_.get(key);
    if (node == nullptr) {
      if (rule.required) fail(table_, fmt::format("'{}' is missing in {}", key, where_));
      return;
    }
    read(*node, std::string(key), member, rule);
  }

  /// Call after all fields: a key that no field took is a mistake.
  void refuse_unknown() {
    if (!status_->ok()) return;
    for (const auto& [key, node] : table_) {
      if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
      *status_ = Error{ErrorKind::kInput, fmt::format("unknown key '{}' in {}", key.str(), where_),
                       loc_of(key, file_), suggest_name(key.str(), known_)};
      return;
    }
  }

 private:
  void fail(const toml::node& node, std::string message, std::string hint = {}) {
    if (status_->ok())
      *status_ = Error{ErrorKind::kInput, std::move(message), loc_of(node, file_), std::move(hint)};
  }
  void wrong_type(const toml::node& node, const std::string& key, std::string_view wanted) {
    fail(node, fmt::format("'{}' must be {}, not {}", key, wanted, type_name(node)));
  }

  void read(const toml::node& node, const std::string& key, std::string& out,
            const FieldRule& rule) {
    const auto value = node.value_exact<std::string>();
    if (!value) return wrong_type(node, key, "a string");
    if (!check_text(node, key, *value, rule)) return;
    out = *value;
  }

  // Any value, as it stands.
  void read(const toml::node& node, const std::string&, TomlText& out, const FieldRule&) {
    std::ostringstream text;
    if (const toml::table* table = node.as_table(); table != nullptr) {
      toml::table on_one_line = *table;  // as a value is written, not as a section
      on_one_line.is_inline(true);
      text << on_one_line;
    } else {
      node.visit([&](const auto& value) { text << value; });
    }
    out.text = text.str();
  }

  bool check_text(const toml::node& node, const std::string& key, const std::string& value,
                  const FieldRule& rule) {
    const bool control = std::any_of(value.begin(), value.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    });
    if (control) {
      fail(node, fmt::format("'{}' holds a control character", key));
      return false;
    }
    if (rule.required && value.empty()) {
      fail(node, fmt::format("'{}' is empty", key));
      return false;
    }
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

  void read(const toml::node& node, const std::string& key, std::filesystem::path& out,
            const FieldRule& rule) {
    std::string text;
    read(node, key, text, rule);
    if (status_->ok()) out = text;
  }

  void read(const toml::node& node, const std::string& key, bool& out, const FieldRule&) {
    const auto value = node.value_exact<bool>();
    if (!value) return wrong_type(node, key, "true or false");
    out = *value;
  }

  void read(const toml::node& node, const std::string& key, double& out, const FieldRule& rule) {
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

  static bool in_range(double value, const FieldRule& rule) {
    if (!std::isfinite(value)) return false;
    return rule.open ? value > rule.min && value < rule.max
                     : value >= rule.min && value <= rule.max;
  }

  template <class Integer>
    requires(std::is_integral_v<Integer> && !std::is_same_v<Integer, bool>)
  void read(const toml::node& node, const std::string& key, Integer& out, const FieldRule& rule) {
    const auto value = node.value_exact<int64_t>();
    if (!value) return wrong_type(node, key, "an integer");
    if (std::is_unsigned_v<Integer> && *value < 0)
      return fail(node, fmt::format("'{}' is {}; it must not be negative", key, *value));
    if (!in_range(static_cast<double>(*value), rule))
      return fail(node, fmt::format("'{}' is {}; it must be {}", key, *value, range_text(rule)));
    out = static_cast<Integer>(*value);
  }

  void read(const toml::node& node, const std::string& key, Rational& out, const FieldRule& rule) {
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

  template <size_t n>
  bool read_numbers(const toml::node& node, const std::string& key, double (&out)[n],
                    const FieldRule& rule) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != n) {
      fail(node,
           array == nullptr
               ? fmt::format("'{}' must be an array of {} numbers, not {}", key, n, type_name(node))
               : fmt::format("'{}' must have {} numbers, not {}", key, n, array->size()));
      return false;
    }
    for (size_t i = 0; i < n; ++i) read((*array)[i], fmt::format("{}[{}]", key, i), out[i], rule);
    return status_->ok();
  }

  void read(const toml::node& node, const std::string& key, Vec3& out, const FieldRule& rule) {
    double v[3] = {};
    if (rule.one_for_three && node.is_number()) {
      read(node, key, v[0], rule);
      if (status_->ok()) out = {v[0], v[0], v[0]};
      return;
    }
    if (read_numbers(node, key, v, rule)) out = {v[0], v[1], v[2]};
  }

  void read(const toml::node& node, const std::string& key, std::array<double, 2>& out,
            const FieldRule& rule) {
    double v[2] = {};
    if (read_numbers(node, key, v, rule)) out = {v[0], v[1]};
  }

  void read(const toml::node& node, const std::string& key, CalendarDate& out, const FieldRule&) {
    const auto date = read_date(node);
    if (!date) return fail(node, fmt::format("'{}' is no date", key), "write it as 2026-06-21");
    out = *date;
  }

  void read(const toml::node& node, const std::string& key, ClockTime& out, const FieldRule&) {
    const auto time = read_time(node);
    if (!time)
      return fail(node, fmt::format("'{}' is no time of day", key), "write it as 14:30:00");
    out = *time;
  }

  void read(const toml::node& node, const std::string& key, Quat& out, const FieldRule& rule) {
    double v[4] = {};
    if (!read_numbers(node, key, v, rule)) return;
    if (!(largest_of(v) > 1e-12)) {
      return fail(node, fmt::format("'{}' is zero, which is not a rotation", key),
                  "a quaternion w, x, y, z; no rotation is [1, 0, 0, 0]");
    }
    out = unit_quaternion(v);
  }

  template <class T>
  void read(const toml::node& node, const std::string& key, std::optional<T>& out,
            const FieldRule& rule) {
    T value{};
    read(node, key, value, rule);
    if (status_->ok()) out = value;
  }

  void read(const toml::node& node, const std::string& key, std::vector<OverrideOptions>& out,
            const FieldRule&) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wrong_type(node, key, "a table");
    const Status status = read_overrides(*table, file_, &out);
    if (status_->ok() && !status.ok()) *status_ = status.error();
  }

  // Arrays of plain values replace the default; arrays of tables too.
  template <class T>
  void read(const toml::node& node, const std::string& key, std::vector<T>& out,
            const FieldRule& rule) {
    const toml::array* array = node.as_array();
    if (array == nullptr) {
      if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> &&
                    !std::is_same_v<T, TomlText>) {
        return fail(node,
                    fmt::format("'{}' must be an array of tables, not {}", key, type_name(node)),
                    fmt::format("write [[{}]]", key));
      } else {
        return wrong_type(node, key, "an array");
      }
    }
    std::vector<T> values;
    for (size_t i = 0; i < array->size() && status_->ok(); ++i) {
      read((*array)[i], fmt::format("{}[{}]", key, i), values.emplace_back(), rule);
    }
    if (status_->ok()) out = std::move(values);
  }

  template <class Options>
    requires requires(TableReader& v, Options& o) { visit_fields(v, o); }
  void read(const toml::node& node, const std::string& key, Options& out, const FieldRule&) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wrong_type(node, key, "a table");
    TableReader reader(*table, file_, fmt::format("[{}]", key), status_);
    if constexpr (requires { out.loc; }) out.loc = loc_of(node, file_);
    visit_fields(reader, out);
    reader.refuse_unknown();
  }

  const toml::table& table_;
  const std::string& file_;
  std::string where_;
  Status* status_;
  std::vector<std::string> known_;
};

}  // namespace gloam

#pragma once
// The reader of single values of a TOML file into the types that options have, with their checks.

#include <toml++/toml.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scene/options/field_rule.h"

namespace gloam {

/// "an integer", "a table" …, for messages.
const char* type_name(const toml::node& node);
/// "from 0 to 1 m", for messages.
std::string range_text(const FieldRule& rule);

/// A node as a value is written in TOML, on one line.
std::string toml_text(const toml::node& node);
/// Largest magnitude of four numbers.
double largest_of(const double (&v)[4]);
/// The rotation of a quaternion wxyz that is not zero.
Quat unit_quaternion(const double (&wxyz)[4]);

/// Reads a node into a value of a type that no template makes: text, numbers, vectors, dates. Keeps
/// the first error; later ones are dropped.
class ValueReader {
 public:
  ValueReader(const std::string& file, Status* status) : file_(file), status_(status) {}

 protected:
  void fail(const toml::node& node, std::string message, std::string hint = {});
  void wrong_type(const toml::node& node, const std::string& key, std::string_view wanted);
  void read(const toml::node& node, const std::string& key, std::string& out,
            const FieldRule& rule);
  // Any value, as it stands.
  void read(const toml::node& node, const std::string&, TomlText& out, const FieldRule&);
  bool check_text(const toml::node& node, const std::string& key, const std::string& value,
                  const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, std::filesystem::path& out,
            const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, bool& out, const FieldRule&);
  void read(const toml::node& node, const std::string& key, double& out, const FieldRule& rule);
  static bool in_range(double value, const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, Rational& out, const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, Vec3& out, const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, std::array<double, 2>& out,
            const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, CalendarDate& out, const FieldRule&);
  void read(const toml::node& node, const std::string& key, ClockTime& out, const FieldRule&);
  void read(const toml::node& node, const std::string& key, Quat& out, const FieldRule& rule);
  void read(const toml::node& node, const std::string& key, std::vector<OverrideOptions>& out,
            const FieldRule&);

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

  const std::string& file_;
  Status* status_;
};

}  // namespace gloam

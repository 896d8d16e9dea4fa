#pragma once
// The checks of a [[randomize]]: whether each value that its distribution can give is one that the
// option can have.

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "scene/files/file_finder.h"
#include "scene/randomize/drawn_numbers.h"
#include "scene/toml/table_reader.h"

namespace gloam {

/// Parses and checks the values of one [[randomize]]. Keeps the first error.
class DrawChecks {
 public:
  DrawChecks(const RandomizeOptions& options, const FileFinder* files, Status* status)
      : o_(options), files_(files), status_(status) {}
  /// Checks only, before there are files and generated things.
  DrawChecks(const RandomizeOptions& options, Status* status)
      : o_(options), checks_only_(true), status_(status) {}

  /// From OptionWalker, if nothing has the name: true if the values shall be checked against a
  /// default example.
  bool begin_example(bool is_pattern);
  void end_example() { --examples_; }

 protected:
  bool only_checks() const { return checks_only_ || examples_ > 0; }
  std::nullopt_t fail(std::string message, std::string hint = {});
  // The pair's sizes fit. `round` = the second may come before the first: over midnight.
  void check_order(const Numbers& a, const Numbers& b, bool round);
  void check_sizes(const std::string& path, size_t n, std::initializer_list<size_t> given);
  bool check_override_shape(const Numbers& a, const Numbers& b);
  // A value of the distribution; `table` holds it.
  const toml::node* parse_value(size_t index, toml::table* table);
  std::optional<Numbers> parse_time(size_t index);
  std::optional<Numbers> parse_date(size_t index);
  std::optional<Numbers> parse_numbers(size_t index);

  // A value of the distribution as numbers.
  template <class T>
  std::optional<Numbers> parse(size_t index) {
    if constexpr (std::is_same_v<T, ClockTime>)
      return parse_time(index);
    else if constexpr (std::is_same_v<T, CalendarDate>)
      return parse_date(index);
    else
      return parse_numbers(index);
  }

  // The standard deviation of a time is a number of seconds, of a date of days.
  template <class T>
  std::optional<Numbers> parse_second() {
    return distribution_of(o_).kind == Distribution::kNormal ? parse<double>(1) : parse<T>(1);
  }

  // Checks that each value that the distribution can give is one that the option can have. Values
  // that are added or scaled, and those of the normal distribution, are kept within the range.
  template <class T>
  bool check_all(const std::string& path, std::string_view key, const std::optional<T>& member,
                 const FieldRule& rule) {
    if (!member && o_.operation != "set" && !only_checks()) {
      fail(fmt::format("'{}' has no value to change", path),
           "set a value, or use operation = \"set\"");
      return false;
    }
    return check_all(path, key, member.value_or(T{}), rule);
  }

  template <class T>
  bool check_all(const std::string& path, std::string_view key, const T& member,
                 const FieldRule& rule) {
    const Distribution distribution = distribution_of(o_);
    if (distribution.kind == Distribution::kChoice && o_.operation == "set") {
      for (const TomlText& value : distribution.values)
        if (T copy = member; !read(key, value.text, copy, rule)) return false;
    } else if constexpr (!kIsNumbers<T>) {
      fail(fmt::format("'{}' is not a number", path), "list the possible values with 'choice'");
    } else if (distribution.kind == Distribution::kChoice) {
      for (size_t i = 0; i < o_.choice.size() && status_->ok(); ++i)
        if (const std::optional<Numbers> value = parse<T>(i))
          check_shape(path, member, *value, *value);
    } else {
      const std::optional<Numbers> a = parse<T>(0), b = parse_second<T>();
      if (a && b && check_shape(path, member, *a, *b) && o_.operation == "set" &&
          distribution.kind != Distribution::kNormal)
        check_ends(key, member, rule, *a, *b);
    }
    return status_->ok();
  }

  // Both ends of a range.
  template <class T>
  void check_ends(std::string_view key, const T& member, const FieldRule& rule, const Numbers& a,
                  const Numbers& b) {
    if constexpr (std::is_same_v<T, Quat>) return;  // any angle will do
    const bool whole = kIsInteger<T> && distribution_of(o_).kind == Distribution::kUniform;
    for (const bool low : {true, false}) {
      const Numbers& end = low ? a : b;
      Numbers v = end.size() > 1 ? end : Numbers(written_of(member).size(), end[0]);
      for (double& x : v)
        if (whole) x = low ? std::ceil(x) : std::floor(x);
      T copy = member;
      if (!read(key, value_text(v, member), copy, rule)) return;
    }
    if (whole && std::ceil(a[0]) > std::floor(b[0]))
      fail("there is no integer between the two values");
  }

  template <class T>
  bool check_shape(const std::string& path, const T& member, const Numbers& a, const Numbers& b) {
    check_sizes(path, written_of(member).size(), {a.size(), b.size()});
    if (status_->ok()) check_order(a, b, std::is_same_v<T, ClockTime>);
    if ((kIsTime<T> || std::is_same_v<T, Quat>) && o_.operation != "set")
      fail(fmt::format("'{}' can only be set", path));
    return status_->ok();
  }

  // Reads a value as a scene file's reader would.
  template <class T>
  bool read(std::string_view key, const std::string& value, T& member, const FieldRule& rule) {
    const Result<toml::table> parsed = parse_toml(fmt::format("{} = {}", key, value), o_.loc.file);
    if (!parsed.ok()) {
      fail(fmt::format("'{}' is not a valid value", value));
      return false;
    }
    Status read;
    TableReader(*parsed, o_.loc.file, "a draw", &read)(key, member, rule);
    if (!read.ok()) fail(read.error().message, read.error().hint);
    if constexpr (std::is_same_v<T, std::filesystem::path>)
      if (read.ok() && files_ != nullptr) *status_ = files_->find(&member, o_.loc);
    return status_->ok();
  }

  const RandomizeOptions& o_;
  const bool checks_only_ = false;
  int examples_ = 0;
  const FileFinder* files_ = nullptr;
  Status* status_;
};

}  // namespace gloam

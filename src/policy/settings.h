#pragma once
// Reader of values in a policy's settings: a TOML file, or the metadata of an ONNX file in the same
// form. It keeps the first error; after it all functions return their fallback.

#include <toml++/toml.h>

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Bounds of a number; infinite values are allowed only where `finite` is false.
struct NumberRule {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;  ///< min and max themselves are excluded
  bool finite = true;
};

class Settings {
 public:
  /// `file` names the settings in errors.
  explicit Settings(std::string file) : file_(std::move(file)) {}

  const Status& status() const { return status_; }
  bool ok() const { return status_.ok(); }
  const std::string& file() const { return file_; }

  void fail(const toml::node* node, std::string message, std::string hint = {});
  /// `where` names the table: "[policy]".
  void check_keys(const toml::table& table, std::span<const std::string_view> known,
                  std::string_view where);

  double number(const toml::node& node, const std::string& name, const NumberRule& rule);
  double number(const toml::table& table, std::string_view key, double fallback,
                const NumberRule& rule);
  int whole(const toml::table& table, std::string_view key, int fallback, int min, int max);
  bool flag(const toml::table& table, std::string_view key, bool fallback);
  std::string text(const toml::table& table, std::string_view key, std::string fallback = {});
  /// Index of the word in `choices`.
  size_t choice(const toml::table& table, std::string_view key,
                std::span<const std::string_view> choices);
  /// [low, high], or one number for ± that number; infinite bounds are allowed.
  std::array<double, 2> range(const toml::node& node, const std::string& name);
  std::vector<std::string> names(const toml::table& table, std::string_view key);
  /// A list of finite numbers, or one.
  std::vector<double> numbers(const toml::node& node, const std::string& name);
  const toml::table* table(const toml::table& parent, std::string_view key);

  /// A number of each joint: one for all, a list, or a table of regular expressions (RE2) that
  /// match whole names. An exact name takes precedence over a pattern, a later pattern over an
  /// earlier one. `fallback`: of joints that no pattern matches; without it they are an error.
  std::vector<double> per_joint(const toml::node& node, std::span<const std::string> joints,
                                const std::string& name, std::optional<double> fallback = {});

 private:
  std::vector<double> by_pattern(const toml::table& table, std::span<const std::string> joints,
                                 const std::string& name, std::optional<double> fallback);

  std::string file_;
  Status status_;
};

/// "a, b, c".
std::string joined(std::span<const std::string> names);

}  // namespace gloam

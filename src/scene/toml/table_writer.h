#pragma once
// The visitor that writes one option struct into a TOML table: the reverse of table_reader.h.

#include <fmt/format.h>

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/options/option_fields.h"
#include "scene/toml/value_reader.h"

namespace gloam {

class TableWriter {
 public:
  /// Files are written as seen from `folder` where they lie in it.
  TableWriter(toml::table* out, const std::filesystem::path& folder) : out_(out), folder_(folder) {}

  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule&) {
    write(key, member);
  }

  /// The table of an option struct, without what is as in `defaults` and what its type does not
  /// have; an option that must be given stays.
  template <class Options>
  static toml::table table_of(Options& options, const std::filesystem::path& folder) {
    toml::table all, defaults;
    TableWriter writer(&all, folder), default_writer(&defaults, folder);
    Options fresh{};
    visit_fields(writer, options);
    visit_fields(default_writer, fresh);
    KeyRules rules;
    visit_fields(rules, options);
    for (const auto& [key, node] : defaults) {
      const toml::node* own = all.get(key);
      if (own != nullptr && same(*own, node) && !contains(rules.required, key.str()))
        all.erase(key);
    }
    for (const std::string_view key : rules.absent) all.erase(key);
    return all;
  }

  template <class T>
  static constexpr bool kIsTable = requires(TableWriter& v, T& o) { visit_fields(v, o); };

 private:
  struct KeyRules {
    std::vector<std::string_view> required, absent;
    template <class T>
    void operator()(std::string_view key, T&, const FieldRule& rule) {
      if (rule.required) required.push_back(key);
      if (!rule.not_of.empty()) absent.push_back(key);
    }
  };

  static bool contains(const std::vector<std::string_view>& keys, std::string_view key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  }
  static bool same(const toml::node& a, const toml::node& b) {
    return a.type() == b.type() && a.visit([&b](const auto& value) {
      return value == *b.as<std::remove_cvref_t<decltype(value)>>();
    });
  }

  void put(std::string_view key, auto&& value) {
    out_->insert_or_assign(key, std::forward<decltype(value)>(value));
  }

  void write(std::string_view key, const std::string& value) { put(key, value); }
  void write(std::string_view key, const std::filesystem::path& value) {
    // As far up as a scene's root may lie.
    constexpr auto kMostUp = 4;
    const std::filesystem::path near = value.lexically_relative(folder_);
    const bool is_near = value.is_absolute() && !near.empty() &&
                         std::count(near.begin(), near.end(), "..") <= kMostUp;
    put(key, (is_near ? near : value).string());
  }
  void write(std::string_view key, const TomlText& value) {
    if (value.text.empty()) return;
    toml::table parsed = toml::parse("value = " + value.text);
    put(key, *parsed.get("value"));
  }
  void write(std::string_view key, bool value) { put(key, value); }
  void write(std::string_view key, double value) { put(key, value); }
  template <class Integer>
    requires(std::is_integral_v<Integer> && !std::is_same_v<Integer, bool>)
  void write(std::string_view key, Integer value) {
    put(key, static_cast<int64_t>(value));
  }
  void write(std::string_view key, const Rational& value) {
    if (value.den == 1)
      put(key, value.num);
    else
      put(key, fmt::format("{}/{}", value.num, value.den));
  }
  void write(std::string_view key, const Vec3& v) { put(key, toml::array{v.x, v.y, v.z}); }
  // The reader makes it a unit quaternion, which may change the last bit of one that is; a multiple
  // is written of which it makes this one.
  void write(std::string_view key, const Quat& q) {
    double v[4] = {q.w, q.x, q.y, q.z};
    for (int i = 0; i < 1000; ++i) {
      const double factor = 1 + 0.01 * i;
      const double scaled[4] = {q.w * factor, q.x * factor, q.y * factor, q.z * factor};
      if (!(unit_quaternion(scaled) == q)) continue;
      std::copy_n(scaled, 4, v);
      break;
    }
    put(key, toml::array{v[0], v[1], v[2], v[3]});
  }
  void write(std::string_view key, const std::array<double, 2>& v) {
    put(key, toml::array{v[0], v[1]});
  }
  void write(std::string_view key, const CalendarDate& d) {
    put(key, fmt::format("{:04}-{:02}-{:02}", d.year, d.month, d.day));
  }
  void write(std::string_view key, const ClockTime& t) {
    const auto whole = static_cast<int>(t.second);
    std::string rest = fmt::format("{:.9f}", t.second - whole).substr(1);  // ".500000000"
    put(key, fmt::format("{:02}:{:02}:{:02}{}", t.hour, t.minute, whole, rest));
  }
  template <NamedEnum Enum>
  void write(std::string_view key, Enum value) {
    put(key, to_string(value));
  }
  template <class T>
  void write(std::string_view key, std::optional<T>& value) {
    if (value) write(key, *value);
  }
  template <NamedEnum Enum>
  void write(std::string_view key, std::optional<Enum>& value) {
    put(key, to_string(value));
  }
  void write(std::string_view, std::vector<OverrideOptions>&) {}  // to_toml has lines for them
  template <class T>
  void write(std::string_view key, std::vector<T>& values) {
    toml::array list;
    for (T& value : values) {
      toml::table one;
      TableWriter writer(&one, folder_);
      writer.write("value", value);
      if (const toml::node* node = one.get("value"); node != nullptr) list.push_back(*node);
    }
    put(key, std::move(list));
  }
  template <class Options>
    requires(kIsTable<Options>)
  void write(std::string_view key, Options& options) {
    put(key, table_of(options, folder_));
  }

  toml::table* out_;
  const std::filesystem::path& folder_;
};

}  // namespace gloam

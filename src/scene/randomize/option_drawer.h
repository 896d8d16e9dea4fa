#pragma once
// One [[randomize]] as a leaf of OptionWalker.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "places/dice.h"
#include "scene/files/file_finder.h"
#include "scene/randomize/drawn_numbers.h"
#include "scene/toml/table_reader.h"

namespace gloam {

struct Distribution {
  enum Kind { kUniform, kLogUniform, kNormal, kChoice } kind;
  const std::vector<TomlText>& values;
};
Distribution distribution_of(const RandomizeOptions& options);

/// Place of a choice, by the weights.
size_t choose(const RandomizeOptions& options, Dice* dice);
/// Of mean 0 and variance 1.
double gaussian(Dice* dice);

/// Draws an option and assigns it; a draw depends on seed, path and how often the path was drawn.
/// What a distribution could give is checked as a whole before, so that no seed fails where another
/// does not.
class Drawer {
 public:
  static constexpr bool kNeedsOne = false;  // a generated house has now these materials, now those

  Drawer(const RandomizeOptions& options, uint64_t seed, const FileFinder* files,
         std::map<std::string, int>* times, std::vector<DrawnOption>* drawn, Status* status)
      : o_(options), seed_(seed), files_(files), times_(times), drawn_(drawn), status_(status) {}
  /// One that draws nothing and only checks, before there are files and generated things.
  Drawer(const RandomizeOptions& options, Status* status)
      : o_(options), checks_only_(true), status_(status) {}

  template <class T>
  void operator()(const std::string& path, std::string_view key, T& member, const FieldRule& rule) {
    if (!status_->ok() || !check_all(path, key, member, rule) || only_checks()) return;
    ++fitting_;
    const std::optional<std::string> value = draw(path, member, rule);
    if (!value) return;
    assign(path, key, *value, member, rule);
  }

  /// From OptionWalker, where nothing has the name: true if what such a thing could be given shall
  /// be checked all the same.
  bool begin_example(bool is_pattern) {
    if (!is_pattern && !checks_only_) return false;
    ++examples_;
    return true;
  }
  void end_example() { --examples_; }

  int fitting() const { return fitting_; }  ///< how many options have been drawn

  // Of an [override], whose types are the model's.
  std::optional<std::string> draw_override() {
    Dice dice = dice_for(o_.option);
    if (o_.operation != "set")
      return fail("an override cannot be added to or scaled",
                  "draw its value: operation = \"set\"");
    if (!o_.choice.empty()) return o_.choice[choose(o_, &dice)].text;
    std::optional<Numbers> low = parse<double>(0), high = parse<double>(1);
    if (!low || !high) return std::nullopt;
    if (!check_override_shape(*low, *high)) return std::nullopt;
    const size_t n = std::max(low->size(), high->size());
    Numbers v;
    for (size_t i = 0; i < n; ++i) v.push_back(one(*low, *high, i, &dice));
    return n == 1 ? text_of(v, 0.0) : text_of(v, Vec3{});
  }

 private:
  bool only_checks() const { return checks_only_ || examples_ > 0; }

  std::nullopt_t fail(std::string message, std::string hint = {}) {
    if (status_->ok())
      *status_ =
          Error{ErrorKind::kInput, fmt::format("[[randomize]] of '{}': {}", o_.option, message),
                o_.loc, std::move(hint)};
    return std::nullopt;
  }

  Dice dice_for(const std::string& path) {
    return Dice(seed_, fmt::format("randomize {} {}", path, (*times_)[path]++));
  }

  // One of the values as numbers.
  template <class T>
  std::optional<Numbers> parse(size_t index) {
    const std::string& text = distribution_of(o_).values[index].text;
    const Result<toml::table> parsed = parse_toml("v = " + text, o_.loc.file);
    const toml::node* node = parsed.ok() ? parsed->get("v") : nullptr;
    if (node == nullptr) return fail(fmt::format("'{}' is no value", text));
    if constexpr (std::is_same_v<T, ClockTime>) {
      if (const auto time = read_time(*node)) return numbers_of(*time);
      return fail(fmt::format("{} is no time of day", text), "write it as 14:30:00");
    } else if constexpr (std::is_same_v<T, CalendarDate>) {
      if (const auto date = read_date(*node)) return numbers_of(*date);
      return fail(fmt::format("{} is no date", text), "write it as 2026-06-21");
    } else {
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
      return fail(fmt::format("{} is neither a number nor numbers", text));
    }
  }

  // Component i of a draw between, or about, two values.
  double one(const Numbers& a, const Numbers& b, size_t i, Dice* dice) const {
    const double x = a[a.size() == 1 ? 0 : i], y = b[b.size() == 1 ? 0 : i];
    switch (distribution_of(o_).kind) {
      case Distribution::kLogUniform:
        return std::exp(dice->uniform(std::log(x), std::log(y)));
      case Distribution::kNormal:
        return x + y * gaussian(dice);
      default:
        return dice->uniform(x, y);
    }
  }

  // Of optional options, what is written; a value that is not there cannot be changed.
  template <class T>
  std::optional<std::string> draw(const std::string& path, const std::optional<T>& member,
                                  const FieldRule& rule) {
    return draw(path, member.value_or(T{}), rule);
  }

  template <class T>
  std::optional<std::string> draw(const std::string& path, const T& member, const FieldRule& rule) {
    Dice dice = dice_for(path);
    const Distribution distribution = distribution_of(o_);
    const bool choice = distribution.kind == Distribution::kChoice;
    if (choice && o_.operation == "set") return o_.choice[choose(o_, &dice)].text;
    if constexpr (!kIsNumbers<T>) {
      return std::nullopt;  // check_all has told
    } else {
      const size_t first = choice ? choose(o_, &dice) : 0;
      const std::optional<Numbers> a = parse<T>(first), b = choice ? a : parse_second<T>();
      if (!a || !b) return std::nullopt;
      return draw_numbers(member, rule, *a, *b, &dice);
    }
  }

  // Whether each value that the distribution can give is one that the option can have. What is
  // added or scaled, and the normal distribution, are kept within the range.
  template <class T>
  bool check_all(const std::string& path, std::string_view key, const std::optional<T>& member,
                 const FieldRule& rule) {
    if (!member && o_.operation != "set" && !only_checks()) {
      fail(fmt::format("'{}' has no value that could be changed", path),
           "give it one, or operation = \"set\"");
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
      fail(fmt::format("'{}' is no number", path), "give the values to choose from: choice");
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
    if (whole && std::ceil(a[0]) > std::floor(b[0])) fail("there is no integer between");
  }

  template <class T>
  bool check_shape(const std::string& path, const T& member, const Numbers& a, const Numbers& b) {
    const size_t n = written_of(member).size();
    for (const Numbers& given : {a, b})
      if (given.size() != 1 && given.size() != n)
        fail(fmt::format("'{}' is {} numbers, not {}", path, n, given.size()));
    if (status_->ok()) check_order(a, b, std::is_same_v<T, ClockTime>);
    if ((kIsTime<T> || std::is_same_v<T, Quat>) && o_.operation != "set")
      fail(fmt::format("'{}' can only be set", path));
    return status_->ok();
  }

  // Of a pair whose sizes fit. `round` = the second may come before the first: over midnight.
  void check_order(const Numbers& a, const Numbers& b, bool round) {
    const Distribution::Kind kind = distribution_of(o_).kind;
    const bool is_range = kind == Distribution::kUniform || kind == Distribution::kLogUniform;
    for (size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
      const double x = a[a.size() == 1 ? 0 : i], y = b[b.size() == 1 ? 0 : i];
      if (kind == Distribution::kLogUniform && std::min(x, y) <= 0)
        fail("log_uniform is for numbers above 0");
      if (is_range && x > y && !round) fail("the first value is above the second");
      if (kind == Distribution::kNormal && y < 0) fail("the standard deviation is negative");
    }
  }
  bool check_override_shape(const Numbers& a, const Numbers& b) {
    if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
      fail(fmt::format("one value is {} numbers, the other {}", a.size(), b.size()));
    else
      check_order(a, b, false);
    return status_->ok();
  }

  template <class T>
  static Numbers written_of(const T& member) {
    if constexpr (kIsInteger<T>)
      return numbers_of(static_cast<double>(member));
    else
      return numbers_of(member);
  }
  template <class T>
  static std::string value_text(const Numbers& v, const T& member) {
    if constexpr (kIsInteger<T>)
      return fmt::format("{:.0f}", std::round(v[0]));
    else
      return text_of(v, member);
  }

  // The standard deviation of a time is a number of seconds, of a date of days.
  template <class T>
  std::optional<Numbers> parse_second() {
    return distribution_of(o_).kind == Distribution::kNormal ? parse<double>(1) : parse<T>(1);
  }

  template <class T>
  std::string draw_numbers(const T& member, const FieldRule& rule, const Numbers& a, Numbers b,
                           Dice* dice) {
    const Distribution::Kind kind = distribution_of(o_).kind;
    const Numbers written = written_of(member);
    const size_t n = written.size();
    if (std::is_same_v<T, ClockTime> && kind == Distribution::kUniform && b[0] < a[0])
      b[0] += 86400;
    // Draws that fall out of the option's range are thrown again; at last the nearest is taken.
    const bool kept_inside = kind == Distribution::kNormal || o_.operation != "set";
    constexpr int kMostThrows = 100;
    Numbers v;
    for (int i = 0; i < kMostThrows; ++i) {
      v = changed(throw_once<T>(a, b, n, dice), written);
      const bool inside =
          std::all_of(v.begin(), v.end(), [&](double x) { return x == kept(x, rule); });
      if (!kept_inside || inside || kIsTime<T> || std::is_same_v<T, Quat>) break;
      if (i + 1 == kMostThrows)
        for (double& x : v) x = kept(x, rule);
    }
    return value_text(v, member);
  }

  // One number for all components is one draw for all of them.
  template <class T>
  Numbers throw_once(const Numbers& a, const Numbers& b, size_t n, Dice* dice) const {
    const Distribution::Kind kind = distribution_of(o_).kind;
    Numbers v;
    for (size_t i = 0; i < n; ++i) {
      if (kind == Distribution::kChoice)
        v.push_back(a[a.size() == 1 ? 0 : i]);
      else if (i > 0 && a.size() == 1 && b.size() == 1)
        v.push_back(v[0]);
      else if (kIsInteger<T> && kind == Distribution::kUniform)
        v.push_back(
            std::min(std::floor(b[0]),
                     std::ceil(a[0]) +
                         std::floor(dice->uniform() * (std::floor(b[0]) - std::ceil(a[0]) + 1))));
      else
        v.push_back(one(a, b, i, dice));
    }
    return v;
  }

  Numbers changed(Numbers v, const Numbers& written) const {
    for (size_t i = 0; i < v.size(); ++i) {
      if (o_.operation == "add") v[i] += written[i];
      if (o_.operation == "scale") v[i] *= written[i];
    }
    return v;
  }

  static double kept(double x, const FieldRule& rule) {
    const double low = rule.open ? std::nextafter(rule.min, INFINITY) : rule.min;
    const double high = rule.open ? std::nextafter(rule.max, -INFINITY) : rule.max;
    return std::clamp(x, low, high);
  }

  // Reads a value as a scene file's reader would.
  template <class T>
  bool read(std::string_view key, const std::string& value, T& member, const FieldRule& rule) {
    const Result<toml::table> parsed = parse_toml(fmt::format("{} = {}", key, value), o_.loc.file);
    if (!parsed.ok()) {
      fail(fmt::format("'{}' is no value", value));
      return false;
    }
    Status read;
    TableReader(*parsed, o_.loc.file, "a draw", &read)(key, member, rule);
    if (!read.ok()) fail(read.error().message, read.error().hint);
    if constexpr (std::is_same_v<T, std::filesystem::path>)
      if (read.ok() && files_ != nullptr) *status_ = files_->find(&member, o_.loc);
    return status_->ok();
  }

  template <class T>
  void assign(const std::string& path, std::string_view key, const std::string& value, T& member,
              const FieldRule& rule) {
    if (read(key, value, member, rule)) drawn_->push_back({path, value});
  }

  const RandomizeOptions& o_;
  const bool checks_only_ = false;
  int examples_ = 0, fitting_ = 0;
  const uint64_t seed_ = 0;
  const FileFinder* files_ = nullptr;
  std::map<std::string, int>* times_ = nullptr;
  std::vector<DrawnOption>* drawn_ = nullptr;
  Status* status_;
};

}  // namespace gloam

#pragma once
// One [[randomize]] as a leaf of OptionWalker.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "places/dice.h"
#include "scene/files/file_finder.h"
#include "scene/randomize/draw_checks.h"
#include "scene/randomize/drawn_numbers.h"

namespace gloam {

/// Place of a choice, by the weights.
size_t choose(const RandomizeOptions& options, Dice* dice);
/// Normal random number of mean 0 and variance 1.
double gaussian(Dice* dice);

/// Draws an option and assigns it; a draw depends on seed, path and how often the path was drawn.
/// The values that a distribution can give are checked as a whole before, so that no seed fails
/// where another does not.
class Drawer : private DrawChecks {
 public:
  static constexpr bool kNeedsOne = false;  // a generated house has now these materials, now those

  Drawer(const RandomizeOptions& options, uint64_t seed, const FileFinder* files,
         std::map<std::string, int>* times, std::vector<DrawnOption>* drawn, Status* status)
      : DrawChecks(options, files, status), seed_(seed), times_(times), drawn_(drawn) {}
  /// One that draws nothing and only checks, before there are files and generated things.
  Drawer(const RandomizeOptions& options, Status* status) : DrawChecks(options, status) {}

  template <class T>
  void operator()(const std::string& path, std::string_view key, T& member, const FieldRule& rule) {
    if (!status_->ok() || !check_all(path, key, member, rule) || only_checks()) return;
    ++fitting_;
    const std::optional<std::string> value = draw(path, member, rule);
    if (!value) return;
    assign(path, key, *value, member, rule);
  }

  using DrawChecks::begin_example;
  using DrawChecks::end_example;

  int fitting() const { return fitting_; }  ///< number of options that have been drawn

  // The value of an [override], whose types are the model's.
  std::optional<std::string> draw_override();

 private:
  Dice dice_for(const std::string& path);
  // Component i of a draw between, or about, two values.
  double one(const Numbers& a, const Numbers& b, size_t i, Dice* dice) const;
  Numbers changed(Numbers v, const Numbers& written) const;
  static double kept(double x, const FieldRule& rule);

  // Draws an optional option from its written value; a missing value cannot be changed.
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
      return std::nullopt;  // check_all has reported it
    } else {
      const size_t first = choice ? choose(o_, &dice) : 0;
      const std::optional<Numbers> a = parse<T>(first), b = choice ? a : parse_second<T>();
      if (!a || !b) return std::nullopt;
      return draw_numbers(member, rule, *a, *b, &dice);
    }
  }

  template <class T>
  std::string draw_numbers(const T& member, const FieldRule& rule, const Numbers& a, Numbers b,
                           Dice* dice) {
    const Distribution::Kind kind = distribution_of(o_).kind;
    const Numbers written = written_of(member);
    const size_t n = written.size();
    if (std::is_same_v<T, ClockTime> && kind == Distribution::kUniform && b[0] < a[0])
      b[0] += 86400;
    // Draws outside of the option's range are repeated; at last the nearest value is taken.
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

  template <class T>
  void assign(const std::string& path, std::string_view key, const std::string& value, T& member,
              const FieldRule& rule) {
    if (read(key, value, member, rule)) drawn_->push_back({path, value});
  }

  int fitting_ = 0;
  const uint64_t seed_ = 0;
  std::map<std::string, int>* times_ = nullptr;
  std::vector<DrawnOption>* drawn_ = nullptr;
};

}  // namespace gloam

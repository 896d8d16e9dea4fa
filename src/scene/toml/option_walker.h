#pragma once
// Walks down a path of names, "camera.front.width", to the options that it means.

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "scene/options/field_rule.h"
#include "scene/options/option_fields.h"
#include "scene/toml/absent_options.h"

namespace gloam {

/// Names between the dots of a path; one in double quotes may hold dots.
std::vector<std::string> split_option_path(std::string_view path);

/// A visitor of fields. Calls `leaf(path, key, member, rule)` for each option that the names mean:
/// one of a list by its name or number, or all whose names fit where a name has a *. A table that
/// may be left out comes into being with its first option. If nothing has the name, that is an
/// error if Leaf::kNeedsOne; else the leaf may ask for an example: its begin_example(is the name a
/// pattern?) returns true and end_example() follows.
template <class Leaf>
class OptionWalker {
 public:
  /// `path`: of what is above, with a dot at its end; `loc`: for errors.
  OptionWalker(std::span<const std::string> names, std::string path, const SourceLoc& loc,
               Leaf* leaf, Status* status)
      : names_(names), path_(std::move(path)), loc_(loc), leaf_(leaf), status_(status) {}

  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule& rule) {
    if (!rule.not_of.empty()) return absent_.note(key, rule);
    known_.emplace_back(key);
    if (found_ || names_[0] != key) return;
    found_ = true;
    walk(key, member, rule);
  }

  /// Call after all fields.
  void finish() {
    if (found_) return;
    if (Status absent = absent_.error(names_[0], known_, loc_); status_->ok() && !absent.ok())
      *status_ = std::move(absent);
    else
      fail(fmt::format("unknown option '{}'", names_[0]), suggest_name(names_[0], known_));
  }

 private:
  template <class T>
  static constexpr bool kIsTable = requires(OptionWalker& v, T& o) { visit_fields(v, o); };

  void fail(std::string message, std::string hint = {}) {
    if (status_->ok())
      *status_ = Error{ErrorKind::kUsage, std::move(message), loc_, std::move(hint)};
  }

  template <class T>
  void walk(std::string_view key, T& member, const FieldRule& rule) {
    if (names_.size() == 1) return (*leaf_)(fmt::format("{}{}", path_, key), key, member, rule);
    if constexpr (kIsTable<T>)
      descend(member, fmt::format("{}{}.", path_, key), 1);
    else
      fail(fmt::format("'{}' has no option '{}'", key, names_[1]));
  }

  template <class T>
    requires(kIsTable<T>)
  void walk(std::string_view key, std::optional<T>& member, const FieldRule& rule) {
    if (names_.size() > 1 && !member) member.emplace();
    if (names_.size() > 1) return walk(key, *member, rule);
    (*leaf_)(fmt::format("{}{}", path_, key), key, member, rule);
  }

  template <class T>
    requires(kIsTable<T>)
  void walk(std::string_view key, std::vector<T>& members, const FieldRule& rule) {
    if (names_.size() == 1) return (*leaf_)(fmt::format("{}{}", path_, key), key, members, rule);
    if (names_.size() == 2)
      return fail(fmt::format("'{}' needs a name or number and an option", key),
                  fmt::format("as in {}.0.{}", key, "name"));
    std::vector<std::string> present;
    const std::vector<size_t> meant = which(members, &present);
    if constexpr (!Leaf::kNeedsOne) {
      const bool is_pattern = names_[1].find('*') != std::string::npos;
      if (meant.empty() && leaf_->begin_example(is_pattern)) {
        T example{};
        descend(example, fmt::format("{}{}.{}.", path_, key, names_[1]), 2);
        return leaf_->end_example();
      }
    }
    if (meant.empty())
      return fail(fmt::format("there is no {} '{}'", key, names_[1]),
                  suggest_name(names_[1], present));
    for (const size_t i : meant) {
      const bool named =
          present.size() > i && !present[i].empty() && present[i].find('.') == std::string::npos;
      descend(members[i],
              fmt::format("{}{}.{}.", path_, key, named ? present[i] : std::to_string(i)), 2);
    }
  }

  // Members that names_[1] means; `names` becomes those of all, where they have any.
  template <class T>
  std::vector<size_t> which(const std::vector<T>& members, std::vector<std::string>* names) const {
    const std::string& wanted = names_[1];
    if constexpr (requires { members[0].name; }) {
      for (const T& member : members) names->push_back(member.name);
      for (size_t i = members.size(); i-- > 0;)
        if ((*names)[i] == wanted) return {i};
    }
    size_t number = members.size();
    const char* const end = wanted.data() + wanted.size();
    if (std::from_chars(wanted.data(), end, number).ptr == end && number < members.size())
      return {number};
    std::vector<size_t> fitting;
    if (wanted.find('*') == std::string::npos) return fitting;
    for (size_t i = 0; i < members.size(); ++i)
      if (fits_pattern(wanted, names->empty() ? std::string() : (*names)[i])) fitting.push_back(i);
    return fitting;
  }

  template <class T>
  void descend(T& options, std::string path, size_t done) {
    OptionWalker inner(names_.subspan(done), std::move(path), loc_, leaf_, status_);
    visit_fields(inner, options);
    inner.finish();
  }

  std::span<const std::string> names_;
  std::string path_;
  const SourceLoc& loc_;
  Leaf* leaf_;
  Status* status_;
  std::vector<std::string> known_;
  AbsentOptions absent_;
  bool found_ = false;
};

/// All of a scene.
template <class Leaf>
void walk_options(std::span<const std::string> names, const SourceLoc& loc, Scene* scene,
                  Leaf* leaf, Status* status) {
  SceneHeader header{scene->name};
  OptionWalker walker(names, "", loc, leaf, status);
  visit_tables(walker, header, *scene);
  walker.finish();
  if (status->ok()) scene->name = header.name;
}

}  // namespace gloam

#pragma once
// The whole grammar of MJCF as data: every element and attribute that the MuJoCo at hand reads,
// with type, length, keywords, default, unit and text. generate_schema.py makes the table when
// Gloam is built, out of MuJoCo's own library and manual.

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

enum class MjcfType : uint8_t { kString, kInt, kReal, kKeyword };

struct MjcfAttribute {
  static constexpr int kAnyLength = -1;

  std::string_view name;
  MjcfType type = MjcfType::kString;
  int least = 1, most = 1;     ///< number of numbers or keywords it takes; most may be kAnyLength
  std::string_view keywords;   ///< keywords of kKeyword, separated by spaces
  bool is_required = false;    ///< the parser refuses an element without it
  std::string_view otherwise;  ///< value that holds where it is not given; "" = none, or it depends
  std::string_view unit;       ///< "kg m^2"; "m|rad": which of them, the joint or tendon says
  std::string_view text;       ///< text of the manual
  /// MJCF lacks it: the field of this name in one of mjSpec's structs, "mjsMesh". Only models in
  /// TOML can give it.
  std::string_view spec_owner;

  bool is_spec_only() const { return !spec_owner.empty(); }
};

struct MjcfElement {
  std::string_view path;  ///< "mujoco/body/joint"; the world's body is "mujoco/body" too
  std::string_view name;  ///< its last part
  char times = '*';       ///< it may stand: ! once, ? at most once, * often, R in itself too
  std::span<const MjcfAttribute> attributes;
  std::vector<const MjcfElement*> children;
  const MjcfElement* parent = nullptr;

  const MjcfAttribute* find(std::string_view attribute) const;
};

class MjcfSchema {
 public:
  static const MjcfSchema& get();

  const MjcfElement& root() const { return elements_.front(); }
  std::span<const MjcfElement> elements() const { return elements_; }  ///< in the grammar's order
  const MjcfElement* find(std::string_view path) const;
  /// Element that <tag> is inside of `above`; null if it may not stand there. <frame> and
  /// <replicate> hold the same elements as bodies.
  const MjcfElement* child(const MjcfElement& above, std::string_view tag) const;
  /// Tag of `element` inside of `above`: the world's body is <worldbody>.
  static std::string_view tag(const MjcfElement& element, const MjcfElement& above);
  /// Tags that may stand in it.
  std::vector<std::string> tags_in(const MjcfElement& above) const;

  /// MJCF's own, without what is spec-only.
  int attribute_count() const { return attribute_count_; }

 private:
  MjcfSchema();

  std::vector<MjcfElement> elements_;
  const MjcfElement* body_ = nullptr;
  const MjcfElement* include_ = nullptr;
  int attribute_count_ = 0;
};

/// The words of a list, without the blanks between; views of `text`.
std::vector<std::string_view> split_words(std::string_view text);

/// A whole word as a number; nothing if it is none, or too large.
template <class T>
std::optional<T> read_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  T value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc() && end == word.data() + word.size() ? std::optional<T>(value)
                                                                 : std::nullopt;
}

/// All words of a list as numbers; nothing if one is none.
template <class T>
std::optional<std::vector<T>> read_numbers(std::string_view text) {
  std::vector<T> list;
  for (const std::string_view word : split_words(text)) {
    const std::optional<T> value = read_number<T>(word);
    if (!value) return {};
    list.push_back(*value);
  }
  return list;
}

/// Is `text` what the attribute takes? Errors say what it takes and name the nearest keyword.
Status check_mjcf_value(const MjcfAttribute& attribute, std::string_view text);

/// "3 numbers [m]", "one of hinge, slide, ball, free" …
std::string describe_type(const MjcfAttribute& attribute);

}  // namespace gloam

#pragma once
// Names of the values of enums, and display of untrusted text (names, keys, messages).

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// A value of an enum and its name in scene files, on command lines, in logs and in Python.
template <class Enum>
struct EnumName {
  Enum value;
  const char* name;
};

/// The table of an enum, specialized beside it: kNoun, such as "render tier", for messages, and
/// kNames, an array of EnumName in the order of lists. Texts, parsers, validation, schemas, --help
/// and the lists in messages derive from it.
template <class Enum>
struct EnumTable;

template <class T>
concept NamedEnum = requires {
  EnumTable<T>::kNoun;
  EnumTable<T>::kNames;
};

template <NamedEnum Enum>
constexpr const char* to_string(Enum value) {
  for (const auto& row : EnumTable<Enum>::kNames)
    if (row.value == value) return row.name;
  return "";
}
/// "" if it is empty.
template <NamedEnum Enum>
constexpr const char* to_string(const std::optional<Enum>& value) {
  return value ? to_string(*value) : "";
}

/// The value with this name; empty if there is none.
template <NamedEnum Enum>
constexpr std::optional<Enum> find_enum(std::string_view name) {
  for (const auto& row : EnumTable<Enum>::kNames)
    if (row.name == name) return row.value;
  return {};
}

/// All names, in the order of the table.
template <NamedEnum Enum>
std::vector<std::string> enum_names() {
  std::vector<std::string> names;
  for (const auto& row : EnumTable<Enum>::kNames) names.emplace_back(row.name);
  return names;
}

/// The error "there is no NOUN 'NAME'"; its hint is the nearest of `names`, or lists all of them.
Error unknown_name(std::string_view noun, std::string_view name,
                   std::span<const std::string> names);

/// Error: no value has this name; the message suggests the nearest.
template <NamedEnum Enum>
Result<Enum> enum_named(std::string_view name) {
  if (const std::optional<Enum> value = find_enum<Enum>(name)) return *value;
  return unknown_name(EnumTable<Enum>::kNoun, name, enum_names<Enum>());
}

/// Returns `text` in a form that cannot control a terminal: control characters, line separators and
/// direction marks are escaped as \n, \x1b, \u009b, \u202e, and bytes that are not UTF-8 as \x9b.
/// `kept`: control characters that are not escaped.
std::string printable(std::string_view text, std::string_view kept = {});

}  // namespace gloam

#pragma once
// The visitor that fills one option struct from one TOML table. All in a header because it is a
// template over every struct of option_fields.h, for two users: whole files and single overrides.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text.h"
#include "scene/options/option_fields.h"
#include "scene/toml/absent_options.h"
#include "scene/toml/toml_reader.h"
#include "scene/toml/value_reader.h"

namespace gloam {

class TableReader : private ValueReader {
 public:
  TableReader(const toml::table& table, const std::string& file, std::string where, Status* status)
      : ValueReader(file, status), table_(table), where_(std::move(where)) {}

  /// One field of the struct that this table fills.
  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule& rule) {
    if (!rule.not_of.empty()) return absent_.note(key, rule);
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
      *status_ = absent_.error(key.str(), known_, loc_of(key, file_));
      if (status_->ok())
        *status_ =
            Error{ErrorKind::kInput, fmt::format("unknown key '{}' in {}", key.str(), where_),
                  loc_of(key, file_), suggest_name(key.str(), known_)};
      return;
    }
  }

 private:
  using ValueReader::read;

  template <class T>
  void read(const toml::node& node, const std::string& key, std::optional<T>& out,
            const FieldRule& rule) {
    T value{};
    read(node, key, value, rule);
    if (status_->ok()) out = value;
  }

  // Optional values may be written as "", which is the absent one, if their rule allows it.
  template <NamedEnum Enum>
  void read(const toml::node& node, const std::string& key, std::optional<Enum>& out,
            const FieldRule& rule) {
    std::string name;
    read(node, key, name, rule);
    if (status_->ok()) out = find_enum<Enum>(name);
  }
  template <NamedEnum Enum>
  void read(const toml::node& node, const std::string& key, Enum& out, const FieldRule& rule) {
    std::optional<Enum> value;
    read(node, key, value, rule);
    if (value) out = *value;
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
  std::string where_;
  std::vector<std::string> known_;
  AbsentOptions absent_;
};

}  // namespace gloam

#pragma once
// Damaged TOML that is TOML: keys, values and tables change, so that damage gets behind the parser.

#include <toml++/toml.h>

#include <sstream>
#include <string>

#include <vector>

#include "base/test/mutator.h"

namespace gloam {

class TomlMutator {
 public:
  explicit TomlMutator(uint64_t seed) : random_(seed) {}

  void mutate(toml::table* document) {
    for (uint32_t times = 1 + random_.draw(4); times > 0; --times) {
      tables_.clear();
      lists_.clear();
      keys_.clear();
      collect(document);
      if (!lists_.empty() && random_.draw(4) == 0)
        change_list(lists_[random_.draw(lists_.size())]);
      else
        change_table(tables_[random_.draw(tables_.size())]);
    }
  }

 private:
  void collect(toml::table* table) {
    tables_.push_back(table);
    for (auto&& [key, node] : *table) {
      keys_.emplace_back(key.str());
      collect_value(&node);
    }
  }

  void collect_value(toml::node* node) {
    if (toml::table* table = node->as_table()) return collect(table);
    toml::array* list = node->as_array();
    if (list == nullptr || list->empty()) return;
    lists_.push_back(list);
    for (toml::node& child : *list) collect_value(&child);
  }

  const std::string& any_key() { return keys_[random_.draw(keys_.size())]; }

  void change_table(toml::table* table) {
    if (table->empty()) {
      if (!keys_.empty()) table->insert_or_assign(any_key(), int64_t{1});
      return;
    }
    auto at = table->begin();
    std::advance(at, random_.draw(table->size()));
    const std::string key(at->first.str());
    switch (random_.draw(6)) {
      case 0:
        table->erase(key);
        break;
      case 1:  // its value under another key of the document
        assign(table, any_key(), at->second);
        break;
      case 2: {  // the value of another table's key
        const toml::table& other = *tables_[random_.draw(tables_.size())];
        if (const toml::node* node = other.get(any_key())) assign(table, key, *node);
        break;
      }
      default:
        change_value(table, key);
    }
  }

  void change_list(toml::array* list) {
    const size_t i = random_.draw(list->size());
    switch (random_.draw(3)) {
      case 0:
        list->erase(list->begin() + static_cast<std::ptrdiff_t>(i));
        break;
      case 1:
        if (list->get(i)->is_number()) list->push_back(number());
        break;
      default:
        if (list->get(i)->is_number())
          list->replace(list->begin() + static_cast<std::ptrdiff_t>(i), number());
    }
  }

  void change_value(toml::table* table, const std::string& key) {
    const toml::node& node = *table->get(key);
    if (node.is_integer() && random_.draw(2) == 0) {
      static const int64_t kWhole[] = {0, 1, -1, 65536, 2147483648, INT64_MAX};
      table->insert_or_assign(key, kWhole[random_.draw(std::size(kWhole))]);
    } else if (node.is_number()) {
      table->insert_or_assign(key, number());
    } else if (const auto* text = node.as_string()) {
      std::string changed = random_.mutate(text->get());
      for (char& c : changed)
        if (static_cast<unsigned char>(c) >= 0x80) c = '?';  // TOML is UTF-8
      table->insert_or_assign(key, std::move(changed));
    } else if (const auto* flag = node.as_boolean()) {
      table->insert_or_assign(key, !flag->get());
    }
  }

  double number() {
    static const double kNumbers[] = {0, 1, -1, 0.5, 1e-12, 1e9, 1e39, -1e39, 1e308};
    return kNumbers[random_.draw(std::size(kNumbers))];
  }

  // Nested copies would grow without end.
  static void assign(toml::table* table, const std::string& key, const toml::node& node) {
    if (node.is_table() || node.is_array()) return;
    node.visit([&](const auto& value) {
      if constexpr (toml::is_value<decltype(value)>) table->insert_or_assign(key, value);
    });
  }

  Mutator random_;
  std::vector<toml::table*> tables_;
  std::vector<toml::array*> lists_;
  std::vector<std::string> keys_;
};

/// The document with damage; text that is no TOML stays.
inline std::string mutate_toml(const std::string& text, uint64_t seed) {
  try {
    toml::table document = toml::parse(text);
    TomlMutator(seed).mutate(&document);
    std::ostringstream out;
    out << toml::toml_formatter(document);
    return out.str();
  } catch (const toml::parse_error&) {
    return text;
  }
}

}  // namespace gloam

#include "scene/toml/overlay.h"

#include <optional>
#include <string>
#include <utility>

namespace gloam {
namespace {

toml::table* find_named(toml::array& list, const toml::table& wanted) {
  const auto name = wanted["name"].value<std::string>();
  if (!name) return nullptr;
  for (toml::node& item : list)
    if (toml::table* table = item.as_table();
        table && (*table)["name"].value<std::string>() == name)
      return table;
  return nullptr;
}

void overlay_list(toml::array&& over, toml::array* base) {
  for (toml::node& item : over) {
    toml::table& table = *item.as_table();
    if (toml::table* same = find_named(*base, table))
      overlay_table(std::move(table), same);
    else
      base->push_back(std::move(table));
  }
}

bool are_table_lists(const toml::node& a, const toml::node& b) {
  return a.is_array_of_tables() && b.is_array_of_tables();
}

}  // namespace

void overlay_table(toml::table&& over, toml::table* base) {
  for (auto&& [key, node] : over) {
    toml::node* below = base->get(key);
    if (below != nullptr && below->is_table() && node.is_table())
      overlay_table(std::move(*node.as_table()), below->as_table());
    else if (below != nullptr && are_table_lists(*below, node))
      overlay_list(std::move(*node.as_array()), below->as_array());
    else
      base->insert_or_assign(key, std::move(node));
  }
}

}  // namespace gloam

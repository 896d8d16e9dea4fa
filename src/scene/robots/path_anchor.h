#pragma once
// Makes the paths of a TOML table absolute, by the types of the options that its keys mean.

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "scene/files/model_path.h"
#include "scene/options/option_fields.h"

namespace gloam {

class PathAnchor {
 public:
  explicit PathAnchor(const std::filesystem::path& folder) : folder_(folder) {}

  /// A table with keys of [[robot]].
  void anchor_robot(toml::table* table) {
    RobotOptions robot;
    anchor(*table, robot);
  }
  /// A table of a list of the scene, such as [[lidar]].
  void anchor_section(std::string_view section, toml::table* table) {
    section_ = section;
    table_ = table;
    Scene scene;
    SceneHeader header;
    SectionVisitor visitor{this};
    visit_tables(visitor, header, scene);
  }

  /// One field of the struct of the present table.
  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule&) {
    if (toml::node* node = table_->get(key)) anchor(*node, member);
  }

 private:
  struct SectionVisitor {
    PathAnchor* anchor;
    template <class T>
    void operator()(std::string_view key, T&, const FieldRule&) {
      (void)key;
    }
    template <class T>
    void operator()(std::string_view key, std::vector<T>&, const FieldRule&) {
      T fresh{};
      if (key == anchor->section_) anchor->anchor(*anchor->table_, fresh);
    }
  };

  void anchor(toml::node& node, std::filesystem::path&) {
    if (toml::value<std::string>* text = node.as_string(); text != nullptr && !text->get().empty())
      text->get() = absolute_path(text->get(), folder_).string();
  }
  template <class T>
  void anchor(toml::node& node, std::optional<T>&) {
    T fresh{};
    anchor(node, fresh);
  }
  template <class T>
  void anchor(toml::node& node, std::vector<T>&) {
    toml::array* list = node.as_array();
    if (list == nullptr) return;
    for (toml::node& item : *list) {
      T fresh{};
      anchor(item, fresh);
    }
  }
  template <class T>
  void anchor(toml::node& node, T& fresh) {
    if constexpr (requires(PathAnchor& v) { visit_fields(v, fresh); }) {
      toml::table* const above = table_;
      table_ = node.as_table();
      if (table_ != nullptr) visit_fields(*this, fresh);
      table_ = above;
    }
  }

  const std::filesystem::path folder_;
  std::string_view section_;
  toml::table* table_ = nullptr;
};

}  // namespace gloam

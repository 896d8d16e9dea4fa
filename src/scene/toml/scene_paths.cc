#include "scene/toml/scene_paths.h"

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/files/model_path.h"
#include "scene/options/option_fields.h"
#include "scene/toml/value_reader.h"

namespace gloam {
namespace {

namespace fs = std::filesystem;
using PathFunction = std::function<void(fs::path*)>;

/// Walks over the strings of a TOML value and replaces those that are paths of files.
class TextPaths {
 public:
  TextPaths(const fs::path& folder, const PathFunction& f) : folder_(folder), f_(f) {}

  void visit(toml::node& node) {
    if (toml::table* table = node.as_table())
      for (auto&& [key, value] : *table) visit(value);
    if (toml::array* array = node.as_array())
      for (toml::node& value : *array) visit(value);
    if (toml::value<std::string>* text = node.as_string()) {
      std::error_code code;
      if (text->get().empty()) return;
      fs::path path = absolute_path(text->get(), folder_);
      if (!fs::is_regular_file(path, code)) return;
      f_(&path);
      text->get() = path.string();
      found_ = true;
    }
  }
  bool found() const { return found_; }

 private:
  const fs::path& folder_;
  const PathFunction& f_;
  bool found_ = false;
};

class PathVisitor {
 public:
  PathVisitor(const fs::path& folder, const PathFunction& f) : folder_(folder), f_(f) {}

  template <class T>
  void operator()(std::string_view, T& member, const FieldRule&) {
    visit(member);
  }

 private:
  template <class T>
  static constexpr bool kIsTable = requires(PathVisitor& v, T& o) { visit_fields(v, o); };

  void visit(fs::path& path) {
    if (!path.empty()) f_(&path);
  }
  void visit(TomlText& value) {
    if (value.text.find_first_of("\"'") == std::string::npos) return;
    toml::table parsed = toml::parse("value = " + value.text);
    TextPaths paths(folder_, f_);
    paths.visit(*parsed.get("value"));
    if (paths.found()) value.text = toml_text(*parsed.get("value"));
  }
  template <class T>
  void visit(std::optional<T>& option) {
    if (option) visit(*option);
  }
  template <class T>
  void visit(std::vector<T>& list) {
    if constexpr (!std::is_arithmetic_v<T>)
      for (T& member : list) visit(member);
  }
  template <class T>
  void visit(T& option) {
    if constexpr (kIsTable<T>) visit_fields(*this, option);
  }

  const fs::path& folder_;
  const PathFunction& f_;
};

}  // namespace

void visit_scene_paths(Scene* scene, const PathFunction& f) {
  SceneHeader header;
  const fs::path folder = scene->file.parent_path();
  PathVisitor visitor(folder, f);
  visit_tables(visitor, header, *scene);
}

}  // namespace gloam

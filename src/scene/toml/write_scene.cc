// Scenes as TOML, and single options of them.

#include <sstream>

#include "gloam/options.h"
#include "scene/toml/option_walker.h"
#include "scene/toml/table_writer.h"

namespace gloam {
namespace {

std::string quoted(const std::string& text) { return toml_text(toml::value<std::string>(text)); }

// Lines, since their order counts and a table of TOML has none. Of two for one attribute the later
// holds.
std::string override_lines(const std::vector<OverrideOptions>& overrides) {
  std::vector<std::pair<std::string, std::string>> lines;  // key, value
  for (const OverrideOptions& o : overrides) {
    std::string key = quoted(o.robot);
    size_t begin = 0;
    for (size_t end = 0; end != std::string::npos; begin = end + 1) {
      end = o.tag.find('/', begin);
      key += "." + quoted(o.tag.substr(begin, end - begin));
    }
    if (!o.pattern.empty()) key += "." + quoted(o.pattern);
    key += "." + quoted(o.attribute);
    std::erase_if(lines, [&key](const auto& line) { return line.first == key; });
    lines.emplace_back(std::move(key), quoted(o.value));
  }
  std::string text;
  for (const auto& [key, value] : lines) text += key + " = " + value + "\n";
  return text.empty() ? text : "\n[override]\n" + text;
}

// Writes one option as a value.
struct OptionGetter {
  static constexpr bool kNeedsOne = true;
  const std::filesystem::path& folder;
  std::string* value;
  Status* status;

  template <class T>
  void operator()(const std::string& path, std::string_view key, T& member, const FieldRule& rule) {
    if (!value->empty()) return;
    toml::table table;
    TableWriter writer(&table, folder);
    writer(key, member, rule);
    const toml::node* node = table.get(key);
    if (node == nullptr && status->ok())
      *status = Error{ErrorKind::kInput, fmt::format("'{}' is not set", path)};
    if (node != nullptr) *value = toml_text(*node);
  }
};

// Lists every option below the tables that there are.
class OptionLister {
 public:
  OptionLister(std::string above, const std::filesystem::path& folder, std::vector<OptionInfo>* out)
      : above_(std::move(above)), folder_(folder), out_(out) {}

  template <class T>
  void operator()(std::string_view key, T& member, const FieldRule& rule) {
    if (rule.not_of.empty()) list(above_ + std::string(key), member, rule);
  }

 private:
  void list(const std::string&, std::vector<OverrideOptions>&, const FieldRule&) {}

  template <class T>
    requires(TableWriter::kIsTable<T>)
  void list(const std::string& path, T& options, const FieldRule&) {
    OptionLister inner(path + ".", folder_, out_);
    visit_fields(inner, options);
  }
  template <class T>
    requires(TableWriter::kIsTable<T>)
  void list(const std::string& path, std::optional<T>& options, const FieldRule& rule) {
    if (options) list(path, *options, rule);
  }
  template <class T>
    requires(TableWriter::kIsTable<T>)
  void list(const std::string& path, std::vector<T>& members, const FieldRule& rule) {
    for (size_t i = 0; i < members.size(); ++i) {
      std::string name = std::to_string(i);
      if constexpr (requires { members[i].name; }) {
        const std::string& own = members[i].name;
        if (!own.empty() && own.find_first_of(".\"") == std::string::npos) name = own;
      }
      list(path + "." + name, members[i], rule);
    }
  }
  template <class T>
  void list(const std::string& path, T& member, const FieldRule& rule) {
    toml::table table;
    TableWriter writer(&table, folder_);
    writer("value", member, rule);
    const toml::node* node = table.get("value");
    OptionInfo info{path, node != nullptr ? toml_text(*node) : "", std::string(rule.unit), rule.min,
                    rule.max};
    info.choices.assign(rule.choices.begin(), rule.choices.end());
    out_->push_back(std::move(info));
  }

  std::string above_;
  const std::filesystem::path& folder_;
  std::vector<OptionInfo>* out_;
};

}  // namespace

std::string to_toml(const Scene& scene) {
  Scene copy = scene, fresh;
  SceneHeader header{scene.name}, fresh_header;
  const std::filesystem::path folder = scene.file.parent_path();
  toml::table all, defaults;
  TableWriter writer(&all, folder), default_writer(&defaults, folder);
  visit_tables(writer, header, copy);
  visit_tables(default_writer, fresh_header, fresh);
  for (const auto& [key, node] : defaults) {
    const toml::node* own = all.get(key);
    const toml::array* list = own != nullptr ? own->as_array() : nullptr;
    const toml::table* table = own != nullptr ? own->as_table() : nullptr;
    const bool empty = (list != nullptr && list->empty()) || (table != nullptr && table->empty());
    if (empty) all.erase(key);
  }
  std::ostringstream text;
  text << toml::toml_formatter(all) << "\n" << override_lines(scene.overrides);
  return text.str();
}

Result<std::string> get_option(const Scene& scene, std::string_view path) {
  Scene copy = scene;
  const std::filesystem::path folder = scene.file.parent_path();
  std::string value;
  Status status;
  OptionGetter getter{folder, &value, &status};
  const std::vector<std::string> names = split_option_path(path);
  walk_options(names, {fmt::format("option '{}'", path), 0, 0}, &copy, &getter, &status);
  GLOAM_TRY_STATUS(status);
  return value;
}

std::vector<OptionInfo> list_options(const Scene& scene) {
  Scene copy = scene;
  SceneHeader header{scene.name};
  std::vector<OptionInfo> out;
  const std::filesystem::path folder = scene.file.parent_path();
  OptionLister lister("", folder, &out);
  visit_tables(lister, header, copy);
  return out;
}

}  // namespace gloam

// MJCF as TOML: [mujoco] holds an attribute per key and a table, or an array of tables, per tag.

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "scene/files/xml_text.h"
#include "scene/mjcf/node.h"
#include "scene/mjcf/toml_value.h"
#include "scene/toml/toml_reader.h"

namespace gloam {

std::optional<std::string> mjcf_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return mjcf::number_text(number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  const auto* array = node.as_array();
  if (array == nullptr) return {};
  std::string text;
  for (const toml::node& item : *array) {
    const std::optional<std::string> word = item.is_array() ? std::nullopt : mjcf_text(item);
    if (!word) return {};
    text += (text.empty() ? "" : " ") + *word;
  }
  return text;
}

std::string mjcf_keyword(const MjcfAttribute& attribute, std::string text) {
  if (attribute.keywords != "disable enable") return text;
  return text == "true" ? "enable" : text == "false" ? "disable" : text;
}

namespace mjcf {
namespace {

struct Below {
  std::string tag;
  const toml::table* table;
};

class TomlReader {
 public:
  explicit TomlReader(const std::string& file) : file_(file) {}

  Status read(const toml::table& from, Node* to, int depth) const {
    if (depth > kDeepestXml)
      return Error{ErrorKind::kInput,
                   fmt::format("tables are nested more than {} deep", kDeepestXml), to->loc};
    std::vector<Below> below;
    std::vector<std::pair<std::string, const toml::node*>> values;
    for (const auto& [key, node] : from) {
      const toml::array* array = node.as_array();
      const bool has_tables = array != nullptr && !array->empty() && array->front().is_table();
      if (const toml::table* table = node.as_table()) {
        below.push_back({std::string(key.str()), table});
      } else if (has_tables) {
        for (const toml::node& item : *array) {
          if (!item.is_table())
            return Error{ErrorKind::kInput,
                         fmt::format("'{}' mixes tables and other values", key.str()),
                         loc_of(item, file_)};
          below.push_back({std::string(key.str()), item.as_table()});
        }
      } else {
        values.emplace_back(std::string(key.str()), &node);
      }
    }
    // toml++ sorts keys: the order of the elements, which numbers them, is that of the text.
    const auto place = [](const toml::node* node) {
      const toml::source_position at = node->source().begin;
      return std::pair(at.line, at.column);
    };
    std::ranges::stable_sort(values, {}, [&](const auto& value) { return place(value.second); });
    std::ranges::stable_sort(below, {}, [&](const Below& item) { return place(item.table); });
    for (const auto& [key, node] : values) GLOAM_TRY_STATUS(read_value(key, *node, to));
    for (const auto& [tag, table] : below) {
      GLOAM_TRY(const std::shared_ptr<Node> child, to->add(tag, loc_of(*table, file_)));
      GLOAM_TRY_STATUS(read(*table, child.get(), depth + 1));
    }
    return {};
  }

 private:
  Status read_value(const std::string& key, const toml::node& node, Node* to) const {
    const SourceLoc loc = loc_of(node, file_);
    if (to->element->path == kTextPath && key == "content") {
      to->content = mjcf_text(node).value_or("");
      return {};
    }
    GLOAM_TRY(const MjcfAttribute* attribute, attribute_of(*to->element, key, loc));
    const std::optional<std::string> text = mjcf_text(node);
    if (!text)
      return Error{ErrorKind::kInput,
                   fmt::format("'{}' must be {}", key, describe_type(*attribute)), loc};
    const std::string value = mjcf_keyword(*attribute, *text);
    if (Status status = check_mjcf_value(*attribute, value); !status.ok()) {
      Error error = to->refused(status.error());
      error.loc = loc;
      return error;
    }
    to->set(*attribute, value);
    return {};
  }

  std::string file_;
};

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : as_utf8(text)) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string toml_number(std::string_view word, MjcfType type) {
  if (type == MjcfType::kInt) return std::to_string(read_number<int>(word).value_or(0));
  const std::string text = number_text(read_number<double>(word).value_or(0));
  return text.find_first_of(".eni") == std::string::npos ? text + ".0" : text;
}

std::string toml_value(const MjcfAttribute& attribute, const std::string& value) {
  if (attribute.type == MjcfType::kString || attribute.type == MjcfType::kKeyword) {
    if (value == "true" || value == "false")
      return attribute.type == MjcfType::kKeyword ? value : quoted(value);
    return quoted(value);
  }
  std::string list;
  const std::vector<std::string_view> words = split_words(value);
  for (const std::string_view word : words)
    list += (list.empty() ? "" : ", ") + toml_number(word, attribute.type);
  return words.size() == 1 && attribute.least <= 1 ? list : fmt::format("[{}]", list);
}

void write_comment(const std::string& comment, std::string* out) {
  if (comment.empty()) return;
  size_t begin = 0;
  while (begin <= comment.size()) {
    const size_t end = std::min(comment.find('\n', begin), comment.size());
    std::string line = as_utf8(comment.substr(begin, end - begin));
    std::erase_if(line, [](char c) { return (c >= 0 && c < 0x20 && c != '\t') || c == 0x7f; });
    *out += fmt::format("#{}\n", line);
    begin = end + 1;
  }
}

void write_node(const Node& node, const std::string& path, bool is_list, std::string* out) {
  *out += '\n';
  write_comment(node.comment, out);
  *out += is_list ? fmt::format("[[{}]]\n", path) : fmt::format("[{}]\n", path);
  for (const auto& [attribute, value] : node.values)
    *out += fmt::format("{} = {}\n", attribute->name, toml_value(*attribute, value));
  if (!node.content.empty()) *out += fmt::format("content = {}\n", quoted(node.content));
  for (const std::shared_ptr<Node>& child : node.children) {
    const bool is_alone = std::ranges::count(node.children, child->tag(),
                                             [](const auto& other) { return other->tag(); }) == 1;
    // <asset>, <option> … may stand twice and hardly ever do.
    const bool is_section = node.parent == nullptr && is_alone;
    const bool may_repeat = child->element->times == '*' || child->element->times == 'R';
    write_node(*child, fmt::format("{}.{}", path, child->tag()), may_repeat && !is_section, out);
  }
  write_comment(node.last_comment, out);
}

}  // namespace

Status read_toml(std::string_view text, const std::string& file, Node* root) {
  GLOAM_TRY(const toml::table table, parse_toml(text, file));
  const toml::table* top = table["mujoco"].as_table();
  if (top == nullptr)
    return Error{
        ErrorKind::kInput,
        "there is no [mujoco]",
        {file, 0, 0},
        "a TOML model has only the table [mujoco]; a scene has [[robot]] (docs/scenes.md)"};
  for (const auto& [key, node] : table) {
    if (key.str() != "mujoco")
      return Error{ErrorKind::kInput, fmt::format("'{}' is outside of [mujoco]", key.str()),
                   loc_of(node, file), "a TOML model has only the table [mujoco]"};
  }
  root->loc = loc_of(*top, file);
  return TomlReader(file).read(*top, root, 1);
}

std::string write_toml(const Node& root) {
  std::string text;
  write_node(root, "mujoco", false, &text);
  return text.substr(1);
}

}  // namespace mjcf
}  // namespace gloam

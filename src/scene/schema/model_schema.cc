// The JSON Schema of models in TOML, out of the table of MJCF's grammar. Draft 7, as
// scene_schema.cc.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gloam/mjcf.h"
#include "scene/mjcf/node.h"
#include "scene/mjcf/schema.h"

namespace gloam::mjcf {
namespace {

using Json = nlohmann::ordered_json;

// "mujoco/body/joint" -> "mujoco.body.joint": in a pointer, / would need an escape.
std::string definition_name(const MjcfElement& element) {
  std::string name(element.path);
  std::ranges::replace(name, '/', '.');
  return name;
}

Json reference(const MjcfElement& element) {
  return {{"$ref", "#/definitions/" + definition_name(element)}};
}

// A word as TOML has it: `true`, 3, 0.5, "hinge". Null if it is no value of this type.
Json value_of(MjcfType type, std::string_view word) {
  if (type == MjcfType::kKeyword)
    return word == "true" ? Json(true) : word == "false" ? Json(false) : Json(word);
  if (type == MjcfType::kInt) {
    const auto value = read_number<int>(word);
    return value ? Json(*value) : Json();
  }
  const auto value = read_number<double>(word);
  return value ? Json(*value) : Json();
}

Json default_of(const MjcfAttribute& attribute) {
  if (attribute.type == MjcfType::kString) return attribute.otherwise;
  Json list = Json::array();
  for (const std::string_view word : split_words(attribute.otherwise)) {
    list.push_back(value_of(attribute.type, word));
    if (list.back().is_null()) return {};
  }
  return list.size() == 1 && attribute.least <= 1 ? list[0] : list;
}

Json number_schema(const MjcfAttribute& attribute) {
  const char* const number = attribute.type == MjcfType::kInt ? "integer" : "number";
  if (attribute.most == 1) return {{"type", number}};
  Json schema;
  if (attribute.least <= 1)
    schema["type"] = {number, "array"};
  else
    schema["type"] = "array";
  schema["items"] = {{"type", number}};
  schema["minItems"] = attribute.least;
  if (attribute.most != MjcfAttribute::kAnyLength) schema["maxItems"] = attribute.most;
  return schema;
}

Json keyword_schema(const MjcfAttribute& attribute) {
  Json words = Json::array();
  const std::vector<std::string_view> keywords = split_words(attribute.keywords);
  for (const std::string_view word : keywords) {
    words.push_back(value_of(attribute.type, word));
    if (words.back().is_boolean()) words.push_back(word);  // "true", as in MJCF, is read too
  }
  if (attribute.keywords == "disable enable") words.insert(words.end(), {true, false});
  if (attribute.most == 1) return {{"enum", words}};
  const std::string any = fmt::format("({})", fmt::join(keywords, "|"));
  return {{"anyOf",
           {{{"type", "string"}, {"pattern", fmt::format("^{0}( {0})*$", any)}},
            {{"type", "array"}, {"items", {{"enum", words}}}}}}};
}

Json schema_of(const MjcfAttribute& attribute) {
  Json schema = attribute.type == MjcfType::kString    ? Json{{"type", "string"}}
                : attribute.type == MjcfType::kKeyword ? keyword_schema(attribute)
                                                       : number_schema(attribute);
  const std::string type =
      attribute.type == MjcfType::kString ? "" : describe_type(attribute) + "; ";
  schema["description"] = fmt::format("{}{}", type, attribute.text);
  if (!attribute.otherwise.empty())
    if (Json otherwise = default_of(attribute); !otherwise.is_null())
      schema["default"] = std::move(otherwise);
  return schema;
}

Json schema_of(const MjcfElement& element) {
  Json properties = Json::object(), required = Json::array();
  for (const MjcfAttribute& attribute : element.attributes) {
    properties[std::string(attribute.name)] = schema_of(attribute);
    if (attribute.is_required) required.push_back(attribute.name);
  }
  if (element.path == kTextPath) properties["content"] = {{"type", "string"}};
  for (const std::string& tag : MjcfSchema::get().tags_in(element))
    properties[tag] = reference(*MjcfSchema::get().child(element, tag));
  Json schema;
  if (element.times == '*' || element.times == 'R') {
    // One table, or an array of them: the words for tables hold for tables, `items` for arrays.
    schema["type"] = {"object", "array"};
    schema["items"] = reference(element);
  } else {
    schema["type"] = "object";
  }
  schema["properties"] = std::move(properties);
  schema["additionalProperties"] = false;
  if (!required.empty()) schema["required"] = std::move(required);
  schema["description"] = fmt::format("MJCF <{}>", element.name);
  return schema;
}

}  // namespace

std::string model_schema() {
  const MjcfSchema& grammar = MjcfSchema::get();
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", "Model in TOML for Gloam"},
                 {"type", "object"},
                 {"properties", {{"mujoco", reference(grammar.root())}}},
                 {"required", {"mujoco"}},
                 {"additionalProperties", false}};
  for (const MjcfElement& element : grammar.elements())
    schema["definitions"][definition_name(element)] = schema_of(element);
  return schema.dump(1);
}

}  // namespace gloam::mjcf

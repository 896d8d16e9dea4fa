// The JSON Schema of models in TOML, out of the table of MJCF's grammar. Draft 7, as
// scene_schema.cc.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gloam/mjcf.h"
#include "scene/mjcf/node.h"
#include "scene/mjcf/schema.h"
#include "scene/schema/attribute_schema.h"

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

Json schema_of(const MjcfElement& element) {
  Json properties = Json::object(), required = Json::array();
  for (const MjcfAttribute& attribute : element.attributes) {
    properties[std::string(attribute.name)] = attribute_schema(attribute);
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

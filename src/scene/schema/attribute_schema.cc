#include "scene/schema/attribute_schema.h"

#include <fmt/format.h>

namespace gloam {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

Json attribute_schema(const MjcfAttribute& attribute) {
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

}  // namespace gloam

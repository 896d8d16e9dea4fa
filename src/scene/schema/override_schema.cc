#include "scene/schema/override_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scene/overrides.h"
#include "scene/schema/attribute_schema.h"

namespace gloam {
namespace {

using Json = nlohmann::ordered_json;

class Definitions {
 public:
  // [override.ROBOT]
  Json robot() {
    Json tags = Json::object();
    for (const MjcfElement& element : MjcfSchema::get().elements()) {
      const std::string tag(element.name);
      const std::vector<const MjcfElement*> elements = overridden_elements(tag);
      if (elements.empty() || tags.contains(tag)) continue;
      if (is_once(*elements[0])) {
        tags[tag] = once(*elements[0]);
      } else {
        all_["override." + tag] = table(attributes_of(elements));
        tags[tag] = {{"type", "object"}, {"additionalProperties", reference("override." + tag)}};
      }
    }
    return table(std::move(tags));
  }
  Json take() { return std::move(all_); }

 private:
  static Json reference(const std::string& definition) {
    return {{"$ref", "#/definitions/" + definition}};
  }
  static Json table(Json properties) {
    return {
        {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  }

  // [override.ROBOT.visual], and in it [override.ROBOT.visual.map]
  Json once(const MjcfElement& element) {
    Json properties = attributes_of({&element});
    for (const MjcfElement* child : element.children)
      properties[std::string(child->name)] = once(*child);
    return table(std::move(properties));
  }

  // Attributes of a group of elements, say all actuators. Where they differ, either's values.
  Json attributes_of(const std::vector<const MjcfElement*>& elements) {
    Json properties = Json::object();
    // Schemas by the values that they allow
    std::map<std::string_view, std::map<std::string, Json>> kinds;
    for (const MjcfElement* element : elements) {
      for (const MjcfAttribute& attribute : element->attributes) {
        Json schema = attribute_schema(attribute);
        schema.erase("default");  // the file's value holds where nothing is overridden
        Json takes = schema;
        takes.erase("description");
        auto& known = kinds[attribute.name];
        const auto [kind, is_new] = known.try_emplace(takes.dump());
        if (!is_new) continue;
        kind->second = definition_of(*element, attribute, std::move(schema));
        Json any = Json::array();
        for (const auto& [text, one] : known) any.push_back(one);
        properties[std::string(attribute.name)] =
            known.size() == 1 ? kind->second : Json{{"anyOf", any}};
      }
    }
    return properties;
  }

  // Many elements have the same attribute: it stands there once.
  Json definition_of(const MjcfElement& element, const MjcfAttribute& attribute, Json schema) {
    std::string name = fmt::format("{}/{}", element.path, attribute.name);
    std::ranges::replace(name, '/', '.');  // in a pointer, / would need an escape
    const auto [known, is_new] = names_.try_emplace(schema.dump(), name);
    if (is_new) all_[name] = std::move(schema);
    return reference(known->second);
  }

  Json all_ = Json::object();
  std::map<std::string, std::string> names_;  // names of definitions, by their content
};

}  // namespace

Json override_definitions() {
  Definitions definitions;
  Json robot = definitions.robot();
  Json all = definitions.take();
  all["override"] = std::move(robot);
  return all;
}

}  // namespace gloam

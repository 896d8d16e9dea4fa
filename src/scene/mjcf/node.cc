#include "scene/mjcf/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "base/check.h"
#include "base/text.h"

namespace gloam::mjcf {
namespace {

Error wrong_tag(const MjcfElement& above, std::string_view tag, const SourceLoc& loc) {
  const MjcfSchema& schema = MjcfSchema::get();
  Error error{ErrorKind::kInput, fmt::format("<{:.60}> is not allowed in <{}>", tag, above.name),
              loc};
  const std::vector<std::string> here = schema.tags_in(above);
  if (const std::string near = nearest_name(tag, here); !near.empty()) {
    error.hint = fmt::format("did you mean <{}>?", near);
    return error;
  }
  std::set<std::string> places;
  for (const MjcfElement& element : schema.elements()) {
    if (element.name == tag && element.parent != nullptr)
      places.insert(fmt::format("<{}>", element.parent->name));
  }
  error.hint = !places.empty() ? fmt::format("it is allowed in {}", fmt::join(places, ", "))
               : here.empty()  ? "no elements are allowed there"
                               : fmt::format("allowed elements: {}", fmt::join(here, ", "));
  return error;
}

}  // namespace

const std::string* Node::value_of(const MjcfAttribute& attribute) const {
  for (const auto& [known, value] : values) {
    if (known == &attribute) return &value;
  }
  return nullptr;
}

void Node::set(const MjcfAttribute& attribute, std::string_view value) {
  for (auto& [known, old] : values) {
    if (known == &attribute) {
      old = value;
      return;
    }
  }
  values.emplace_back(&attribute, value);
}

Result<std::shared_ptr<Node>> Node::add(std::string_view tag, const SourceLoc& place) {
  const MjcfElement* below = MjcfSchema::get().child(*element, tag);
  if (below == nullptr) return wrong_tag(*element, tag, place);
  if (below->times == '?' &&
      std::ranges::any_of(children, [&](const auto& child) { return child->element == below; }))
    return Error{ErrorKind::kInput, fmt::format("<{}> appears twice in <{}>", tag, this->tag()),
                 place};
  auto child = std::make_shared<Node>();
  child->element = below;
  child->parent = this;
  child->loc = place;
  children.push_back(child);
  return child;
}

std::string_view Node::tag() const {
  return parent == nullptr ? element->name : MjcfSchema::tag(*element, *parent->element);
}

Error Node::refused(Error error) const {
  error.message = fmt::format("<{}> {}", tag(), error.message);
  error.loc = loc;
  return error;
}

Result<const MjcfAttribute*> attribute_of(const MjcfElement& element, std::string_view name,
                                          const SourceLoc& loc) {
  if (const MjcfAttribute* attribute = element.find(name)) return attribute;
  std::vector<std::string> names;
  for (const MjcfAttribute& attribute : element.attributes) names.emplace_back(attribute.name);
  Error error{ErrorKind::kInput, fmt::format("<{}> has no attribute '{:.60}'", element.name, name),
              loc};
  const std::string near = nearest_name(name, names);
  error.hint = !near.empty()   ? fmt::format("did you mean '{}'?", near)
               : names.empty() ? "it has no attributes"
                               : fmt::format("it has {}", fmt::join(names, ", "));
  return error;
}

std::string number_text(double value) {
  char text[40];
  const auto [end, code] = std::to_chars(text, text + sizeof(text), value);
  GLOAM_CHECK(code == std::errc(), "a number has more digits than a double can have");
  return {text, end};
}

}  // namespace gloam::mjcf

#include "scene/mjcf/spec_only.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scene/mjcf/spec_kinds.h"
#include "scene/mjcf/spec_values.h"

namespace gloam {
namespace {

using mjcf::Element;

std::string value_of(const Element& element, std::string_view attribute) {
  const Result<std::optional<std::string>> value = element.get(attribute);
  return value.ok() ? value->value_or("") : "";
}

// Calls f(element, attribute, value) for all that are not MJCF's.
template <class F>
Status for_each_spec_only(const Element& element, const F& f) {
  for (const MjcfAttribute& attribute : MjcfSchema::get().find(element.path())->attributes) {
    if (!attribute.is_spec_only()) continue;
    const Result<std::optional<std::string>> value = element.get(attribute.name);
    if (value.ok() && value->has_value()) GLOAM_TRY_STATUS(f(element, attribute, **value));
  }
  for (const Element& child : element.children()) GLOAM_TRY_STATUS(for_each_spec_only(child, f));
  return {};
}

// The name that MuJoCo knows the element by: its own, that of the <flex> around an <elasticity>,
// that of a mesh's file.
std::string name_in_spec(const Element& element) {
  const mjtObj type = object_of(*MjcfSchema::get().find(element.path()));
  std::optional<Element> named = element;
  while (named && value_of(*named, "name").empty()) {
    const std::string file = value_of(*named, "file");
    if (!file.empty()) return std::filesystem::path(file).stem().string();
    named = named->parent();
    if (named && object_of(*MjcfSchema::get().find(named->path())) != type) return {};
  }
  return named ? value_of(*named, "name") : "";
}

}  // namespace

Status check_fits_xml(const Element& top) {
  return for_each_spec_only(
      top, [](const Element& element, const MjcfAttribute& attribute, const std::string&) {
        return Status(
            Error{ErrorKind::kUnsupported,
                  fmt::format("MJCF has no attribute '{}' of <{}>", attribute.name, element.tag()),
                  element.loc(), "save the model as .toml"});
      });
}

Status set_spec_only(const mjcf::Document& document, mjSpec* spec) {
  const auto set = [&](const Element& element, const MjcfAttribute& attribute,
                       const std::string& value) -> Status {
    const mjtObj type = object_of(*MjcfSchema::get().find(element.path()));
    const std::string name = name_in_spec(element);
    mjsElement* const target =
        type == mjOBJ_UNKNOWN || name.empty() ? nullptr : mjs_findElement(spec, type, name.c_str());
    if (type != mjOBJ_UNKNOWN && target == nullptr)
      return Error{ErrorKind::kInput,
                   fmt::format("<{}> needs a name to set its '{}'", element.tag(), attribute.name),
                   element.loc()};
    for (const SpecObject& object :
         target == nullptr ? spec_objects(spec) : spec_objects_of(target)) {
      const auto fields = spec_fields_of(object.owner);
      const auto field = std::ranges::find(fields, attribute.name, &SpecField::name);
      if (object.owner != attribute.spec_owner || field == fields.end()) continue;
      const bool is_flag = attribute.type == MjcfType::kKeyword;
      Status status = set_spec_numbers(object, *field,
                                       !is_flag          ? value
                                       : value == "true" ? "1"
                                                         : "0");
      if (status.ok()) return {};
      Error error = status.error();
      error.loc = element.loc();
      return error;
    }
    return Error{
        ErrorKind::kUnsupported,
        fmt::format("this version of MuJoCo has no {}.{}", attribute.spec_owner, attribute.name),
        element.loc()};
  };
  return for_each_spec_only(document.root(), set);
}

}  // namespace gloam

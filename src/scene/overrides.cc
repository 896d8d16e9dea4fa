#include "scene/overrides.h"

#include <fmt/format.h>
#include <re2/re2.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/text.h"
#include "scene/mjcf/spec_kinds.h"
#include "scene/mjcf/spec_table.h"
#include "scene/mjcf/toml_value.h"

namespace gloam {
namespace {

constexpr std::string_view kSingletonSections[] = {"compiler", "option", "size", "statistic",
                                                   "visual"};
constexpr std::string_view kSections[] = {"actuator", "sensor", "tendon", "equality"};

// "visual/map" of "mujoco/visual/map".
std::string_view below_root(const MjcfElement& element) {
  const size_t slash = element.path.find('/');
  return slash == std::string_view::npos ? "" : element.path.substr(slash + 1);
}

bool is_named(const MjcfElement& element) { return object_of(element) != mjOBJ_UNKNOWN; }

Error at(const OverrideOptions& override, Error error) {
  error.loc = override.loc;
  return error;
}

Error unknown_tag(const OverrideOptions& override) {
  std::set<std::string> tags(std::begin(kSections), std::end(kSections));
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    if (is_once(element)) tags.emplace(below_root(element));
    if (is_named(element)) tags.emplace(element.name);
  }
  const std::vector<std::string> list(tags.begin(), tags.end());
  return {ErrorKind::kInput, fmt::format("no element '{:.60}' can be overridden", override.tag),
          override.loc, suggest_name(override.tag, list)};
}

Error unknown_attribute(const OverrideOptions& override) {
  std::set<std::string> names;
  for (const MjcfElement* element : overridden_elements(override.tag)) {
    for (const MjcfAttribute& attribute : element->attributes) names.emplace(attribute.name);
  }
  const std::vector<std::string> list(names.begin(), names.end());
  return {ErrorKind::kInput,
          fmt::format("'{}' has no attribute '{:.60}'", override.tag, override.attribute),
          override.loc, suggest_name(override.attribute, list)};
}

// Values that are parsed once and set in many elements: parsing one asks MuJoCo's parser two dozen
// times.
class Values {
 public:
  explicit Values(const OverrideOptions& override) : override_(override) {}

  Status set(const MjcfElement& element, mjSpec* spec, mjsElement* target) {
    auto known = read_.find(&element);
    if (known == read_.end()) {
      const MjcfAttribute& attribute = *element.find(override_.attribute);
      Result<AttributeValue> value =
          AttributeValue::read(element, attribute, mjcf_keyword(attribute, override_.value));
      if (!value.ok()) return at(override_, value.error());
      known = read_.emplace(&element, std::move(value).value()).first;
    }
    const Status status = known->second.set(spec, target);
    return status.ok() ? Status() : at(override_, status.error());
  }

 private:
  const OverrideOptions& override_;
  std::map<const MjcfElement*, AttributeValue> read_;
};

// One override of named elements, in the turn of patterns or in that of exact names.
class NamedOverride {
 public:
  NamedOverride(const OverrideOptions& override, mjSpec* spec)
      : override_(override),
        spec_(spec),
        pattern_(override.pattern, RE2::Quiet),
        values_(override) {}

  Status apply(bool exact) {
    for (const MjcfElement* element : overridden_elements(override_.tag)) {
      const mjtObj type = object_of(*element);
      for (mjsElement* e = mjs_firstElement(spec_, type); e != nullptr;
           e = mjs_nextElement(spec_, e)) {
        if (!is_written_as(*element, e)) continue;
        const std::string name = mjs_getString(mjs_getName(e));
        if (!exact && !name.empty()) names_.push_back(name);
        const bool is_exact = name == override_.pattern;
        if (!is_exact && !RE2::FullMatch(name, pattern_)) continue;
        any_ = true;
        if (element->find(override_.attribute) == nullptr) continue;  // a motor has no kp
        has_attribute_ = true;
        if (is_exact == exact) GLOAM_TRY_STATUS(values_.set(*element, spec_, e));
      }
    }
    return {};
  }

  Status check_found() const {
    if (has_attribute_) return {};
    if (any_)
      return Error{
          ErrorKind::kInput,
          fmt::format("no {} of '{}' that matches '{:.60}' has an attribute '{}'", override_.tag,
                      override_.robot, override_.pattern, override_.attribute),
          override_.loc};
    return Error{ErrorKind::kInput,
                 fmt::format("no {} of '{}' matches '{:.60}'", override_.tag, override_.robot,
                             override_.pattern),
                 override_.loc,
                 names_.empty() ? "it has none" : suggest_name(override_.pattern, names_)};
  }

 private:
  bool is_written_as(const MjcfElement& element, mjsElement* e) const {
    if (e->elemtype == mjOBJ_BODY) return e != mjs_findBody(spec_, "world")->element;
    const bool has_kinds = e->elemtype == mjOBJ_ACTUATOR || e->elemtype == mjOBJ_SENSOR ||
                           e->elemtype == mjOBJ_TENDON || e->elemtype == mjOBJ_EQUALITY;
    return !has_kinds || written_as(e) == &element;
  }

  const OverrideOptions& override_;
  mjSpec* spec_;
  RE2 pattern_;
  Values values_;
  std::vector<std::string> names_;
  bool any_ = false, has_attribute_ = false;
};

}  // namespace

bool is_once(const MjcfElement& element) {
  const std::string_view path = below_root(element);
  return std::ranges::find(kSingletonSections, path.substr(0, path.find('/'))) !=
         std::end(kSingletonSections);
}

std::vector<const MjcfElement*> overridden_elements(std::string_view tag) {
  std::vector<const MjcfElement*> elements;
  const bool is_section = std::ranges::find(kSections, tag) != std::end(kSections);
  std::set<mjtObj> seen;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    if (is_once(element) && below_root(element) == tag) return {&element};
    if (!is_named(element)) continue;
    if (is_section ? element.parent->name == tag && element.parent->parent != nullptr
                   : element.name == tag)
      elements.push_back(&element);
  }
  // <skin> is allowed in <asset> and in <deformable>, and is one kind of object.
  const auto same = [&](const MjcfElement* e) {
    return !is_section && !seen.insert(object_of(*e)).second;
  };
  std::erase_if(elements, same);
  return elements;
}

Status check_override(const OverrideOptions& override) {
  const std::vector<const MjcfElement*> elements = overridden_elements(override.tag);
  if (elements.empty()) return unknown_tag(override);
  if (is_once(*elements[0]) != override.pattern.empty()) {
    const bool lacks = override.pattern.empty();
    return Error{
        ErrorKind::kInput,
        fmt::format("'{}' {}", override.tag,
                    lacks ? "needs a name" : "is unique and takes no name"),
        override.loc,
        fmt::format("[override.{}.{}{}]", override.robot, override.tag, lacks ? ".\"NAME\"" : "")};
  }
  const RE2 pattern(override.pattern, RE2::Quiet);
  if (!pattern.ok())
    return Error{ErrorKind::kInput,
                 fmt::format("'{:.60}' is not a valid regular expression: {}", override.pattern,
                             pattern.error()),
                 override.loc};
  bool found = false;
  for (const MjcfElement* element : elements) {
    const MjcfAttribute* attribute = element->find(override.attribute);
    if (attribute == nullptr) continue;
    found = true;
    const Status status = check_mjcf_value(*attribute, mjcf_keyword(*attribute, override.value));
    if (!status.ok()) return at(override, status.error());
  }
  return found ? Status() : unknown_attribute(override);
}

Status validate_overrides(const Scene& scene) {
  std::vector<std::string> names = {kEnvironmentName};
  for (const RobotOptions& robot : scene.robots) names.push_back(robot.name);
  for (const OverrideOptions& override : scene.overrides) {
    if (std::ranges::find(names, override.robot) == names.end())
      return Error{ErrorKind::kInput, fmt::format("there is no robot '{:.60}'", override.robot),
                   override.loc, suggest_name(override.robot, names)};
    GLOAM_TRY_STATUS(check_override(override));
  }
  return {};
}

Status apply_overrides(std::span<const OverrideOptions> overrides, const std::string& robot,
                       mjSpec* spec) {
  std::vector<std::unique_ptr<NamedOverride>> named;
  for (const OverrideOptions& override : overrides) {
    if (override.robot != robot) continue;
    if (override.pattern.empty()) {
      GLOAM_TRY_STATUS(Values(override).set(*overridden_elements(override.tag)[0], spec, nullptr));
    } else {
      named.push_back(std::make_unique<NamedOverride>(override, spec));
    }
  }
  for (const bool exact : {false, true}) {
    for (const auto& override : named) GLOAM_TRY_STATUS(override->apply(exact));
  }
  for (const auto& override : named) GLOAM_TRY_STATUS(override->check_found());
  return {};
}

}  // namespace gloam

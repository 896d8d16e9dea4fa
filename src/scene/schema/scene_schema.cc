// The JSON Schema of scene files, out of the tables that the TOML reader reads (option_fields.h),
// the structs' own defaults and what the public headers say of each member (option_texts.inc).
// Draft 7: what VS Code knows in full and Taplo, which checks TOML in editors, in what stands here.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>

#include "gloam/scene.h"
#include "scene/options/option_fields.h"
#include "scene/schema/override_schema.h"

namespace gloam {

#include "option_texts.inc"

namespace {

using Json = nlohmann::ordered_json;

/// Texts of the members of a struct, found by the address of a field: the field `position` is a
/// part of the member X_WR.
class MemberTexts {
 public:
  template <class T>
  void operator()(const T& member, std::string_view text) {
    const auto* begin = reinterpret_cast<const char*>(&member);
    members_.push_back({begin, begin + sizeof(T), text});
    if constexpr (requires { visit_texts(*this, member); }) visit_texts(*this, member);
  }
  /// Text of the smallest member that holds the field.
  std::string find(const void* field) const {
    const Member* best = nullptr;
    for (const Member& member : members_) {
      if (!std::less_equal<const void*>()(member.begin, field) ||
          !std::less<const void*>()(field, member.end))
        continue;
      const ptrdiff_t size = member.end - member.begin;
      const ptrdiff_t least = best == nullptr ? size : best->end - best->begin;
      // A struct's only member, of which nothing is said, is what the struct is.
      if (best == nullptr || size < least || (size == least && !member.text.empty()))
        best = &member;
    }
    return std::string(best == nullptr ? "" : best->text);
  }

 private:
  struct Member {
    const char *begin, *end;
    std::string_view text;
  };
  std::vector<Member> members_;
};

/// A number that is whole is written without a point.
Json number(double value) {
  const auto whole = static_cast<int64_t>(value);
  return std::abs(value) < 1e15 && static_cast<double>(whole) == value ? Json(whole) : Json(value);
}

Json with_range(Json schema, const FieldRule& rule, double least) {
  const double min = std::max(rule.min, least);
  if (std::isfinite(min)) schema[rule.open ? "exclusiveMinimum" : "minimum"] = number(min);
  if (std::isfinite(rule.max))
    schema[rule.open ? "exclusiveMaximum" : "maximum"] = number(rule.max);
  return schema;
}

constexpr double kNoLeast = -std::numeric_limits<double>::infinity();

Json numbers(const FieldRule& rule, std::span<const double> otherwise) {
  Json list = Json::array();
  for (const double value : otherwise) list.push_back(number(value));
  return {{"type", "array"},
          {"items", with_range({{"type", "number"}}, rule, kNoLeast)},
          {"minItems", otherwise.size()},
          {"maxItems", otherwise.size()},
          {"default", list}};
}

// One for each type that TableReader reads. `value` is the default.

Json schema_of(const std::string& value, const FieldRule& rule) {
  Json schema = {{"type", "string"}};
  if (!rule.choices.empty()) schema["enum"] = rule.choices;
  if (rule.identifier)
    schema["pattern"] = "^[^/]+$";
  else if (rule.required)
    schema["minLength"] = 1;
  if (!value.empty()) schema["default"] = value;
  return schema;
}

Json schema_of(const std::filesystem::path& value, const FieldRule& rule) {
  return schema_of(value.string(), rule);
}

template <NamedEnum Enum>
Json schema_of(Enum value, const FieldRule& rule) {
  return schema_of(std::string(to_string(value)), rule);
}

Json schema_of(bool value, const FieldRule& /*rule*/) {
  return {{"type", "boolean"}, {"default", value}};
}

Json schema_of(double value, const FieldRule& rule) {
  Json schema = with_range({{"type", "number"}}, rule, kNoLeast);
  schema["default"] = number(value);
  return schema;
}

template <class Integer>
  requires(std::is_integral_v<Integer>)
Json schema_of(Integer value, const FieldRule& rule) {
  Json schema = with_range({{"type", "integer"}}, rule, std::is_unsigned_v<Integer> ? 0 : kNoLeast);
  schema["default"] = value;
  return schema;
}

Json schema_of(Rational value, const FieldRule& rule) {
  Json schema = with_range({{"type", {"number", "string"}}}, rule, kNoLeast);
  schema["pattern"] = "^-?[0-9]+/[0-9]+$";
  if (value.den == 1)
    schema["default"] = value.num;
  else
    schema["default"] = fmt::format("{}/{}", value.num, value.den);
  return schema;
}

Json schema_of(const Vec3& value, const FieldRule& rule) {
  Json schema = numbers(rule, std::array{value.x, value.y, value.z});
  if (rule.one_for_three) {
    schema["type"] = {"number", "array"};
    schema = with_range(schema, rule, kNoLeast);
  }
  return schema;
}

Json schema_of(const Quat& value, const FieldRule& rule) {
  return numbers(rule, std::array{value.w, value.x, value.y, value.z});
}

Json schema_of(const std::array<double, 2>& value, const FieldRule& rule) {
  return numbers(rule, value);
}

// TOML's own dates and times are text to a JSON Schema.
Json schema_of(const CalendarDate& /*value*/, const FieldRule& /*rule*/) {
  return {{"type", "string"}, {"pattern", "^[0-9]{4}-[0-9]{2}-[0-9]{2}$"}};
}
Json schema_of(const ClockTime& /*value*/, const FieldRule& /*rule*/) {
  return {{"type", "string"}, {"pattern", "^[0-9]{2}:[0-9]{2}(:[0-9]{2}([.][0-9]+)?)?$"}};
}

Json schema_of(const TomlText& /*value*/, const FieldRule& /*rule*/) {
  return {{"type", {"boolean", "number", "string", "array", "object"}}};
}

template <class Options>
  requires requires(Options& o) { struct_text(o); }
Json schema_of(const Options& value, const FieldRule& rule);

template <class T>
Json schema_of(const std::vector<T>& value, const FieldRule& rule);

Json schema_of(const std::vector<OverrideOptions>& /*value*/, const FieldRule& /*rule*/) {
  return {{"type", "object"},
          {"description", struct_text(OverrideOptions{})},
          {"additionalProperties", {{"$ref", "#/definitions/override"}}}};
}

template <class T>
Json schema_of(const std::optional<T>& /*value*/, const FieldRule& rule) {
  Json schema = schema_of(T{}, rule);
  schema.erase("default");
  return schema;
}

template <class T>
Json schema_of(const std::vector<T>& value, const FieldRule& rule) {
  Json item = schema_of(T{}, rule);
  item.erase("default");
  Json schema = {{"type", "array"}, {"items", std::move(item)}};
  if constexpr (!requires(T& o) { struct_text(o); } && !std::is_same_v<T, TomlText>)
    if (!value.empty()) schema["default"] = value;
  return schema;
}

/// A visitor of fields that makes a table's schema.
class TableSchema {
 public:
  explicit TableSchema(MemberTexts texts) : texts_(std::move(texts)) {}

  template <class T>
  void operator()(std::string_view key, const T& member, const FieldRule& rule) {
    Json schema = schema_of(member, rule);
    std::string text = texts_.find(&member);
    // The text of a member in public headers often has its unit.
    if (!rule.unit.empty() && text.find(fmt::format("[{}", rule.unit)) == std::string::npos)
      text += fmt::format("{}[{}]", text.empty() ? "" : " ", rule.unit);
    if (rule.required) {
      (rule.unless.empty() ? required_ : required_unless_).push_back(key);
      unless_ = rule.unless.empty() ? unless_ : rule.unless;
      schema.erase("default");
    }
    if (!text.empty() && !schema.contains("properties")) schema["description"] = text;
    properties_[std::string(key)] = std::move(schema);
  }

  Json take() {
    Json schema = {{"type", "object"},
                   {"properties", std::move(properties_)},
                   {"additionalProperties", false}};
    if (!required_.empty()) schema["required"] = std::move(required_);
    if (!required_unless_.empty())
      schema["anyOf"] = {{{"required", std::move(required_unless_)}},
                         {{"required", Json::array({unless_})}}};
    return schema;
  }

 private:
  MemberTexts texts_;
  Json properties_ = Json::object(), required_ = Json::array(), required_unless_ = Json::array();
  std::string_view unless_;
};

template <class Options>
  requires requires(Options& o) { struct_text(o); }
Json schema_of(const Options& value, const FieldRule& /*rule*/) {
  Options copy = value;  // a visitor of fields may change them
  MemberTexts texts;
  visit_texts(texts, copy);
  TableSchema table(std::move(texts));
  visit_fields(table, copy);
  Json schema = table.take();
  schema["description"] = struct_text(copy);
  return schema;
}

}  // namespace

std::string scene_schema() {
  SceneHeader header;
  Scene scene;
  TableSchema table{{}};
  visit_tables(table, header, scene);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Gloam scene"}};
  schema.update(table.take());
  schema["definitions"] = override_definitions();
  return schema.dump(1);
}

}  // namespace gloam

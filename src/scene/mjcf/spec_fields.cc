#include "scene/mjcf/spec_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mjspecmacro.h>
#include <mujoco/mjxmacro.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "scene/mjcf/node.h"

namespace gloam {
namespace {

// mjString is declared as std::string and is another library's: text goes by MuJoCo's functions.
template <class T>
constexpr SpecType type_of() {
  if constexpr (std::is_same_v<T, mjtBool>) return SpecType::kBool;
  if constexpr (std::is_same_v<T, mjtByte>) return SpecType::kByte;
  if constexpr (std::is_same_v<T, char>) return SpecType::kChar;
  if constexpr (std::is_same_v<T, int> || std::is_enum_v<T>) return SpecType::kInt;
  if constexpr (std::is_same_v<T, mjtSize>) return SpecType::kSize;
  if constexpr (std::is_same_v<T, uint64_t>) return SpecType::kUint64;
  if constexpr (std::is_same_v<T, float>) return SpecType::kFloat;
  if constexpr (std::is_same_v<T, double>) return SpecType::kDouble;
  if constexpr (std::is_same_v<T, mjString*>) return SpecType::kString;
  if constexpr (std::is_same_v<T, mjStringVec*>) return SpecType::kStrings;
  if constexpr (std::is_same_v<T, mjIntVec*>) return SpecType::kInts;
  if constexpr (std::is_same_v<T, mjFloatVec*>) return SpecType::kFloats;
  if constexpr (std::is_same_v<T, mjDoubleVec*>) return SpecType::kDoubles;
  if constexpr (std::is_same_v<T, mjByteVec*>) return SpecType::kBytes;
  if constexpr (std::is_same_v<T, mjIntVecVec*>) return SpecType::kIntLists;
  if constexpr (std::is_same_v<T, mjFloatVecVec*>) return SpecType::kFloatLists;
  return std::is_pointer_v<T> ? SpecType::kHandle : SpecType::kStruct;
}

using VisualGlobal = decltype(mjVisual::global);
using VisualQuality = decltype(mjVisual::quality);
using VisualHeadlight = decltype(mjVisual::headlight);
using VisualMap = decltype(mjVisual::map);
using VisualScale = decltype(mjVisual::scale);
using VisualRgba = decltype(mjVisual::rgba);

std::vector<SpecField> all_fields() {
  std::vector<SpecField> fields;
#define XVEC X
#define GLOAM_FIELD(type, name, count) \
  fields.push_back({owner, #name, #type, type_of<type>(), count, offsetof(S, name)});
#define GLOAM_LIST(structure, list)                \
  {                                                \
    using S = structure;                           \
    constexpr std::string_view owner = #structure; \
    list                                           \
  }
#define X(type, name, count) GLOAM_FIELD(type, name, count)
  GLOAM_LIST(mjSpec, MJSPEC_FIELDS)
  GLOAM_LIST(mjsCompiler, MJSCOMPILER_FIELDS)
  GLOAM_LIST(mjsElement, MJSELEMENT_FIELDS)
  GLOAM_LIST(mjsOrientation, MJSORIENTATION_FIELDS)
  GLOAM_LIST(mjsPlugin, MJSPLUGIN_FIELDS)
  GLOAM_LIST(mjsBody, MJSBODY_FIELDS)
  GLOAM_LIST(mjsFrame, MJSFRAME_FIELDS)
  GLOAM_LIST(mjsJoint, MJSJOINT_FIELDS)
  GLOAM_LIST(mjsGeom, MJSGEOM_FIELDS)
  GLOAM_LIST(mjsSite, MJSSITE_FIELDS)
  GLOAM_LIST(mjsCamera, MJSCAMERA_FIELDS)
  GLOAM_LIST(mjsLight, MJSLIGHT_FIELDS)
  GLOAM_LIST(mjsFlex, MJSFLEX_FIELDS)
  GLOAM_LIST(mjsMesh, MJSMESH_FIELDS)
  GLOAM_LIST(mjsHField, MJSHFIELD_FIELDS)
  GLOAM_LIST(mjsSkin, MJSSKIN_FIELDS)
  GLOAM_LIST(mjsTexture, MJSTEXTURE_FIELDS)
  GLOAM_LIST(mjsMaterial, MJSMATERIAL_FIELDS)
  GLOAM_LIST(mjsPair, MJSPAIR_FIELDS)
  GLOAM_LIST(mjsExclude, MJSEXCLUDE_FIELDS)
  GLOAM_LIST(mjsEquality, MJSEQUALITY_FIELDS)
  GLOAM_LIST(mjsTendon, MJSTENDON_FIELDS)
  GLOAM_LIST(mjsWrap, MJSWRAP_FIELDS)
  GLOAM_LIST(mjsActuator, MJSACTUATOR_FIELDS)
  GLOAM_LIST(mjsSensor, MJSSENSOR_FIELDS)
  GLOAM_LIST(mjsNumeric, MJSNUMERIC_FIELDS)
  GLOAM_LIST(mjsText, MJSTEXT_FIELDS)
  GLOAM_LIST(mjsTuple, MJSTUPLE_FIELDS)
  GLOAM_LIST(mjsKey, MJSKEY_FIELDS)
  GLOAM_LIST(mjsDefault, MJSDEFAULT_FIELDS)
  GLOAM_LIST(mjOption, MJOPTION_FIELDS)
  GLOAM_LIST(VisualGlobal, MJVISUAL_GLOBAL_FIELDS)
  GLOAM_LIST(VisualQuality, MJVISUAL_QUALITY_FIELDS)
  GLOAM_LIST(VisualHeadlight, MJVISUAL_HEADLIGHT_FIELDS)
  GLOAM_LIST(VisualMap, MJVISUAL_MAP_FIELDS)
  GLOAM_LIST(VisualScale, MJVISUAL_SCALE_FIELDS)
  GLOAM_LIST(VisualRgba, MJVISUAL_RGBA_FIELDS)
  // These two have no list of MuJoCo's.
  GLOAM_LIST(mjVisual, X(VisualGlobal, global, 1) X(VisualQuality, quality, 1)
                           X(VisualHeadlight, headlight, 1) X(VisualMap, map, 1)
                               X(VisualScale, scale, 1) X(VisualRgba, rgba, 1))
  GLOAM_LIST(mjLROpt, X(int, mode, 1) X(int, useexisting, 1) X(int, uselimit, 1) X(mjtNum, accel, 1)
                          X(mjtNum, maxforce, 1) X(mjtNum, timeconst, 1) X(mjtNum, timestep, 1)
                              X(mjtNum, inttotal, 1) X(mjtNum, interval, 1) X(mjtNum, tolrange, 1))
#undef X
#define X(name, count) GLOAM_FIELD(mjtNum, name, count)
  GLOAM_LIST(mjStatistic, MJSTATISTIC_FIELDS)
#undef X
#undef XVEC
  return fields;
}

const void* at(const SpecObject& object, const SpecField& field) {
  return static_cast<const char*>(object.address) + field.offset;
}

template <class T>
std::string numbers(const void* first, int count) {
  const auto* values = static_cast<const T*>(first);
  std::string text;
  for (int i = 0; i < count; ++i) {
    if (i > 0) text += ' ';
    if constexpr (std::is_floating_point_v<T>) {
      text += mjcf::number_text(values[i]);
    } else {
      text += std::to_string(values[i]);
    }
  }
  return text;
}

template <class T>
std::string list(const std::vector<T>& values) {
  return "[" + numbers<T>(values.data(), static_cast<int>(values.size())) + "]";
}

template <class T>
std::string lists(const std::vector<std::vector<T>>& values) {
  std::string text = "[";
  for (const std::vector<T>& inner : values) text += list(inner);
  return text + "]";
}

// A vector that MuJoCo keeps: begin, end and capacity in every standard library.
template <class T>
const T& vector_at(const void* field) {
  return **static_cast<T* const*>(field);
}

std::string strings(const mjStringVec* values) {
  std::string text = "[";
  for (int i = 0;; ++i) {
    const char* value = mjs_getInStringVec(values, i);
    if (value == nullptr) return text + "]";
    text += fmt::format("'{}'", value);
  }
}

void add(std::string_view owner, const std::string& label, const void* address,
         std::vector<SpecObject>* objects) {
  objects->push_back({owner, label, address, ""});
  for (const SpecField& field : spec_fields_of(owner)) {
    if (field.type == SpecType::kStruct)
      add(field.type_name, fmt::format("{}.{}", label, field.name),
          static_cast<const char*>(address) + field.offset, objects);
  }
}

struct ElementKind {
  mjtObj type;
  std::string_view owner;
  const void* (*as)(mjsElement*);
};

template <class T, T* (*kAs)(mjsElement*)>
const void* as(mjsElement* element) {
  return kAs(element);
}

constexpr ElementKind kKinds[] = {
    {mjOBJ_BODY, "mjsBody", as<mjsBody, mjs_asBody>},
    {mjOBJ_FRAME, "mjsFrame", as<mjsFrame, mjs_asFrame>},
    {mjOBJ_JOINT, "mjsJoint", as<mjsJoint, mjs_asJoint>},
    {mjOBJ_GEOM, "mjsGeom", as<mjsGeom, mjs_asGeom>},
    {mjOBJ_SITE, "mjsSite", as<mjsSite, mjs_asSite>},
    {mjOBJ_CAMERA, "mjsCamera", as<mjsCamera, mjs_asCamera>},
    {mjOBJ_LIGHT, "mjsLight", as<mjsLight, mjs_asLight>},
    {mjOBJ_FLEX, "mjsFlex", as<mjsFlex, mjs_asFlex>},
    {mjOBJ_MESH, "mjsMesh", as<mjsMesh, mjs_asMesh>},
    {mjOBJ_HFIELD, "mjsHField", as<mjsHField, mjs_asHField>},
    {mjOBJ_SKIN, "mjsSkin", as<mjsSkin, mjs_asSkin>},
    {mjOBJ_TEXTURE, "mjsTexture", as<mjsTexture, mjs_asTexture>},
    {mjOBJ_MATERIAL, "mjsMaterial", as<mjsMaterial, mjs_asMaterial>},
    {mjOBJ_PAIR, "mjsPair", as<mjsPair, mjs_asPair>},
    {mjOBJ_EXCLUDE, "mjsExclude", as<mjsExclude, mjs_asExclude>},
    {mjOBJ_EQUALITY, "mjsEquality", as<mjsEquality, mjs_asEquality>},
    {mjOBJ_TENDON, "mjsTendon", as<mjsTendon, mjs_asTendon>},
    {mjOBJ_ACTUATOR, "mjsActuator", as<mjsActuator, mjs_asActuator>},
    {mjOBJ_SENSOR, "mjsSensor", as<mjsSensor, mjs_asSensor>},
    {mjOBJ_NUMERIC, "mjsNumeric", as<mjsNumeric, mjs_asNumeric>},
    {mjOBJ_TEXT, "mjsText", as<mjsText, mjs_asText>},
    {mjOBJ_TUPLE, "mjsTuple", as<mjsTuple, mjs_asTuple>},
    {mjOBJ_KEY, "mjsKey", as<mjsKey, mjs_asKey>},
    {mjOBJ_PLUGIN, "mjsPlugin", as<mjsPlugin, mjs_asPlugin>},
};

}  // namespace

std::span<const SpecField> spec_fields() {
  static const std::vector<SpecField> fields = all_fields();
  return fields;
}

std::span<const SpecField> spec_fields_of(std::string_view owner) {
  const std::span<const SpecField> all = spec_fields();
  const auto first = std::ranges::find(all, owner, &SpecField::owner);
  const auto last =
      std::find_if(first, all.end(), [&](const SpecField& field) { return field.owner != owner; });
  return {first, last};
}

std::vector<SpecObject> spec_objects(const mjSpec* spec) {
  std::vector<SpecObject> objects;
  add("mjSpec", "mjSpec", spec, &objects);
  for (const ElementKind& kind : kKinds) {
    int i = 0;
    for (mjsElement* e = mjs_firstElement(spec, kind.type); e != nullptr;
         e = mjs_nextElement(spec, e), ++i) {
      const std::string label = fmt::format("{}[{}]", kind.owner, i);
      const size_t place = objects.size();
      add(kind.owner, label, kind.as(e), &objects);
      objects[place].name = mjs_getString(mjs_getName(e));
      if (kind.type != mjOBJ_TENDON) continue;
      const mjsTendon* tendon = mjs_asTendon(e);
      for (int w = 0; w < mjs_getWrapNum(tendon); ++w)
        add("mjsWrap", fmt::format("{}.wrap[{}]", label, w), mjs_getWrap(tendon, w), &objects);
    }
  }
  const mjsDefault* defaults = mjs_getSpecDefault(spec);
  add("mjsDefault", "default", defaults, &objects);
  const std::pair<std::string_view, const void*> kDefaults[] = {
      {"mjsJoint", defaults->joint},       {"mjsGeom", defaults->geom},
      {"mjsSite", defaults->site},         {"mjsCamera", defaults->camera},
      {"mjsLight", defaults->light},       {"mjsFlex", defaults->flex},
      {"mjsMesh", defaults->mesh},         {"mjsTexture", defaults->texture},
      {"mjsMaterial", defaults->material}, {"mjsPair", defaults->pair},
      {"mjsEquality", defaults->equality}, {"mjsTendon", defaults->tendon},
      {"mjsActuator", defaults->actuator}};
  for (const auto& [owner, address] : kDefaults)
    add(owner, fmt::format("default.{}", owner), address, &objects);
  return objects;
}

std::vector<SpecObject> spec_objects_of(mjsElement* element) {
  std::vector<SpecObject> objects;
  for (const ElementKind& kind : kKinds) {
    if (kind.type == element->elemtype)
      add(kind.owner, std::string(kind.owner), kind.as(element), &objects);
  }
  return objects;
}

std::string spec_text(const SpecObject& object, const SpecField& field) {
  const void* value = at(object, field);
  // Defaults lack some of their texts.
  if (field.type >= SpecType::kString && *static_cast<void* const*>(value) == nullptr) return "";
  switch (field.type) {
    case SpecType::kBool:
      return numbers<mjtBool>(value, field.count);
    case SpecType::kByte:
      return numbers<mjtByte>(value, field.count);
    case SpecType::kChar:
      return {static_cast<const char*>(value),
              strnlen(static_cast<const char*>(value), static_cast<size_t>(field.count))};
    case SpecType::kInt:
      return numbers<int>(value, field.count);
    case SpecType::kSize:
      return numbers<mjtSize>(value, field.count);
    case SpecType::kUint64:
      return numbers<uint64_t>(value, field.count);
    case SpecType::kFloat:
      return numbers<float>(value, field.count);
    case SpecType::kDouble:
      return numbers<double>(value, field.count);
    case SpecType::kString:
      return fmt::format("'{}'", mjs_getString(*static_cast<mjString* const*>(value)));
    case SpecType::kStrings:
      return strings(*static_cast<mjStringVec* const*>(value));
    case SpecType::kInts:
      return list(vector_at<mjIntVec>(value));
    case SpecType::kFloats:
      return list(vector_at<mjFloatVec>(value));
    case SpecType::kDoubles:
      return list(vector_at<mjDoubleVec>(value));
    case SpecType::kBytes: {
      const mjByteVec& bytes = vector_at<mjByteVec>(value);
      return "[" + numbers<uint8_t>(bytes.data(), static_cast<int>(bytes.size())) + "]";
    }
    case SpecType::kIntLists:
      return lists(vector_at<mjIntVecVec>(value));
    case SpecType::kFloatLists:
      return lists(vector_at<mjFloatVecVec>(value));
    case SpecType::kStruct:
    case SpecType::kHandle:
      return "";
  }
  return "";
}

bool spec_equal(const SpecObject& a, const SpecObject& b, const SpecField& field) {
  if (field.type < SpecType::kString)
    return std::memcmp(at(a, field), at(b, field),
                       spec_size(field.type) * static_cast<size_t>(field.count)) == 0;
  if (field.type == SpecType::kStruct || field.type == SpecType::kHandle) return true;
  return spec_text(a, field) == spec_text(b, field);
}

size_t spec_size(SpecType type) {
  switch (type) {
    case SpecType::kBool:
    case SpecType::kByte:
    case SpecType::kChar:
      return 1;
    case SpecType::kInt:
    case SpecType::kFloat:
      return 4;
    default:
      return 8;
  }
}

std::vector<std::string> spec_difference(const mjSpec* a, const mjSpec* b) {
  const std::vector<SpecObject> in_a = spec_objects(a), in_b = spec_objects(b);
  std::vector<std::string> found;
  size_t i = 0, k = 0;
  while (i < in_a.size() || k < in_b.size()) {
    if (k == in_b.size() ||
        (i < in_a.size() && in_a[i].label != in_b[k].label &&
         std::ranges::find(in_b, in_a[i].label, &SpecObject::label) == in_b.end())) {
      found.push_back(in_a[i++].label);
      continue;
    }
    if (i == in_a.size() || in_a[i].label != in_b[k].label) {
      found.push_back(in_b[k++].label);
      continue;
    }
    if (in_a[i].name != in_b[k].name) found.push_back(in_a[i].label + ".name");
    for (const SpecField& field : spec_fields_of(in_a[i].owner)) {
      if (!spec_equal(in_a[i], in_b[k], field))
        found.push_back(fmt::format("{}.{}", in_a[i].label, field.name));
    }
    ++i, ++k;
  }
  return found;
}

}  // namespace gloam

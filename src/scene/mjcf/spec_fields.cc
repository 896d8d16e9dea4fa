#include "scene/mjcf/spec_fields.h"

#include <fmt/format.h>
#include <mujoco/mjspecmacro.h>
#include <mujoco/mjxmacro.h>

#include <map>
#include <type_traits>

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
  static const auto by_owner = [] {
    std::map<std::string_view, std::span<const SpecField>> rows;
    const std::span<const SpecField> all = spec_fields();
    for (size_t i = 0; i < all.size(); ++i) {
      auto& row = rows.try_emplace(all[i].owner, all.subspan(i, 0)).first->second;
      row = {row.data(), row.size() + 1};
    }
    return rows;
  }();
  const auto found = by_owner.find(owner);
  return found == by_owner.end() ? std::span<const SpecField>() : found->second;
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

}  // namespace gloam

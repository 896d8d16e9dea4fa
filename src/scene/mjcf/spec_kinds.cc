#include "scene/mjcf/spec_kinds.h"

#include <map>
#include <utility>

#include "base/check.h"
#include "scene/mjcf/specimen.h"

namespace gloam {

mjtObj object_of(const MjcfElement& element) {
  static const std::map<std::string_view, mjtObj> kByPath = {
      {"mujoco/body", mjOBJ_BODY},
      {"mujoco/body/inertial", mjOBJ_BODY},
      {"mujoco/body/joint", mjOBJ_JOINT},
      {"mujoco/body/freejoint", mjOBJ_JOINT},
      {"mujoco/body/geom", mjOBJ_GEOM},
      {"mujoco/body/site", mjOBJ_SITE},
      {"mujoco/body/camera", mjOBJ_CAMERA},
      {"mujoco/body/light", mjOBJ_LIGHT},
      {"mujoco/body/frame", mjOBJ_FRAME},
      {"mujoco/asset/mesh", mjOBJ_MESH},
      {"mujoco/asset/hfield", mjOBJ_HFIELD},
      {"mujoco/asset/skin", mjOBJ_SKIN},
      {"mujoco/asset/texture", mjOBJ_TEXTURE},
      {"mujoco/asset/material", mjOBJ_MATERIAL},
      {"mujoco/contact/pair", mjOBJ_PAIR},
      {"mujoco/contact/exclude", mjOBJ_EXCLUDE},
      {"mujoco/deformable/flex", mjOBJ_FLEX},
      {"mujoco/deformable/skin", mjOBJ_SKIN},
      {"mujoco/custom/numeric", mjOBJ_NUMERIC},
      {"mujoco/custom/text", mjOBJ_TEXT},
      {"mujoco/custom/tuple", mjOBJ_TUPLE},
      {"mujoco/keyframe/key", mjOBJ_KEY}};
  if (const auto found = kByPath.find(element.path); found != kByPath.end()) return found->second;
  const std::string_view section = element.parent == nullptr ? "" : element.parent->path;
  if (section == "mujoco/deformable/flex") return mjOBJ_FLEX;
  return section == "mujoco/tendon"     ? mjOBJ_TENDON
         : section == "mujoco/equality" ? mjOBJ_EQUALITY
         : section == "mujoco/actuator" ? mjOBJ_ACTUATOR
         : section == "mujoco/sensor"   ? mjOBJ_SENSOR
                                        : mjOBJ_UNKNOWN;
}

mjsElement* specimen_of(const mjSpec* spec, const MjcfElement& element) {
  const mjtObj type = object_of(element);
  return type == mjOBJ_UNKNOWN ? nullptr : mjs_findElement(spec, type, mjcf::kSpecimenName);
}

namespace {

// Variant of an element among those of its kind: a servo or a motor, a gyro or a touch sensor.
int variant_of(mjsElement* element) {
  if (const mjsActuator* actuator = mjs_asActuator(element))
    return actuator->plugin.active ? -1 : actuator->type;
  if (const mjsSensor* sensor = mjs_asSensor(element)) return sensor->type;
  if (const mjsEquality* equality = mjs_asEquality(element)) return equality->type;
  if (const mjsTendon* tendon = mjs_asTendon(element))
    return mjs_getWrapNum(tendon) > 0 && mjs_getWrap(tendon, 0)->type == mjWRAP_JOINT ? 1 : 0;
  return 0;
}

std::map<std::pair<mjtObj, int>, const MjcfElement*> all_variants() {
  std::map<std::pair<mjtObj, int>, const MjcfElement*> variants;
  for (const MjcfElement& element : MjcfSchema::get().elements()) {
    const mjtObj type = object_of(element);
    if (type == mjOBJ_UNKNOWN || element.find("name") == nullptr) continue;
    const Result<mjcf::OwnedSpec> spec =
        mjcf::parse_document(mjcf::make_specimen(element).document);
    GLOAM_CHECK(spec.ok(), "MuJoCo cannot parse a specimen");
    if (mjsElement* read = specimen_of(spec->get(), element))
      variants.emplace(std::pair(type, variant_of(read)), &element);
  }
  return variants;
}

}  // namespace

const MjcfElement* written_as(mjsElement* element) {
  static const auto variants = all_variants();
  const auto found = variants.find({element->elemtype, variant_of(element)});
  return found == variants.end() ? nullptr : found->second;
}

}  // namespace gloam

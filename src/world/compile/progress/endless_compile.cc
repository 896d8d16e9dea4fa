#include "world/compile/progress/endless_compile.h"

#include <fmt/format.h>

#include <cmath>

namespace gloam {
namespace {

// Calls f(element) until it returns true.
template <class F>
bool any_of(const mjSpec& spec, mjtObj type, F&& f) {
  for (mjsElement* e = mjs_firstElement(&spec, type); e != nullptr; e = mjs_nextElement(&spec, e)) {
    if (f(e)) return true;
  }
  return false;
}

bool has_length_ranges(const mjSpec& spec) {
  return spec.compiler.LRopt.mode != mjLRMODE_NONE &&
         any_of(spec, mjOBJ_ACTUATOR, [&](mjsElement* e) {
           const mjsActuator* actuator = mjs_asActuator(e);
           return actuator->gaintype == mjGAIN_MUSCLE || actuator->biastype == mjBIAS_MUSCLE ||
                  actuator->gaintype == mjGAIN_USER || actuator->biastype == mjBIAS_USER ||
                  spec.compiler.LRopt.mode == mjLRMODE_ALL;
         });
}

}  // namespace

std::optional<EndlessCompile> find_endless_compile(const mjSpec& spec) {
  if (!has_length_ranges(spec)) return {};
  std::optional<EndlessCompile> found;
  const auto check = [&](mjsElement* e, const char* kind, double armature, const mjString* info) {
    if (armature >= 0 && std::isfinite(armature)) return false;
    const std::string name = mjs_getString(mjs_getName(e));
    found = EndlessCompile{name, fmt::format("{} '{}': armature is {}, {}", kind, name, armature,
                                             mjs_getString(info))};
    return true;
  };
  (void)(any_of(spec, mjOBJ_JOINT,
                [&](mjsElement* e) {
                  const mjsJoint* joint = mjs_asJoint(e);
                  return check(e, "joint", joint->armature, joint->info);
                }) ||
         any_of(spec, mjOBJ_TENDON,
                [&](mjsElement* e) {
                  const mjsTendon* tendon = mjs_asTendon(e);
                  return check(e, "tendon", tendon->armature, tendon->info);
                }) ||
         any_of(spec, mjOBJ_ACTUATOR, [&](mjsElement* e) {
           const mjsActuator* actuator = mjs_asActuator(e);
           return check(e, "actuator", actuator->armature, actuator->info);
         }));
  return found;
}

}  // namespace gloam

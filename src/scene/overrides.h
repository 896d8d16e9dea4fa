#pragma once
// [override]: attributes of a robot's elements, set after its file is parsed and before it joins
// the level.

#include <mujoco/mujoco.h>

#include <span>

#include "gloam/scene.h"
#include "scene/mjcf/schema.h"

namespace gloam {

/// Word that may stand for a robot's name
inline constexpr const char* kEnvironmentName = "environment";

/// Elements that a tag may mean: <joint>; all of <actuator>; <option>, which a model has once.
std::vector<const MjcfElement*> overridden_elements(std::string_view tag);

/// Has a model one of these at most, so that it needs no name?
bool is_once(const MjcfElement& element);

/// Errors: a tag, attribute or value that MJCF does not have, a pattern that is none; with the
/// override's place.
Status check_override(const OverrideOptions& override);

/// check_override of all, and that their robots are there.
Status validate_overrides(const Scene& scene);

/// Those of `robot`, in their order of precedence. Errors: what fits no element; what MuJoCo
/// refuses.
Status apply_overrides(std::span<const OverrideOptions> overrides, const std::string& robot,
                       mjSpec* spec);

}  // namespace gloam

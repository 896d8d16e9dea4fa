#pragma once
// The third stage of compiling: describes all parts of a World that refer to its model.

#include <string>

#include "world/compile/resolve_scene.h"

namespace gloam {

/// `world`: of build_model() or of the cache. `keyframe`: name or number of the keyframe from which
/// a bare model starts; "" = its initial state. Errors: names of bodies, sensors and keyframes that
/// the model lacks.
Status describe_world(const ResolvedScene& resolved, const std::string& keyframe,
                      CompiledWorld* world);

}  // namespace gloam

#pragma once

#include "world/compile/level.h"

namespace gloam {

/// If a robot of the scene starts from a keyframe: adds an empty keyframe "initial" for the level.
void add_initial_keyframe(const Scene& scene, Level* level);

/// Puts the robots' keyframes together in it, in the model and in the spec. Free bodies and mocap
/// bodies are moved along with their robot's root. Errors: a robot has no keyframe of that name.
Status fill_initial_keyframe(Level* level);

}  // namespace gloam

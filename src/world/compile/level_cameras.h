#pragma once

#include "world/compile/level.h"

namespace gloam {

/// Adds the scene's cameras to the level's spec. One that has the name of a camera of the models
/// and says nothing about its pose stands for that one. Errors: unknown body, name taken.
Status add_cameras(const Scene& scene, Level* level);

/// A tracking camera is given in world axes but stored in those of its body, which are known once
/// the model is compiled. Returns true if the spec changed and must be compiled again.
bool turn_tracking_cameras(const Scene& scene, Level* level);

}  // namespace gloam

#pragma once
// Kinds of elements of mjSpec for elements of MJCF, and the way back.

#include <mujoco/mujoco.h>

#include "scene/mjcf/schema.h"

namespace gloam {

/// Kind of the element that MuJoCo makes of it; mjOBJ_UNKNOWN for what a model has once.
mjtObj object_of(const MjcfElement& element);

/// The element of MJCF that one of a spec is written with: <position> for a position servo. Null
/// for kinds that MJCF has no element for.
const MjcfElement* written_as(mjsElement* element);

/// In the spec of its specimen (specimen.h); null for what a model has once.
mjsElement* specimen_of(const mjSpec* spec, const MjcfElement& element);

}  // namespace gloam

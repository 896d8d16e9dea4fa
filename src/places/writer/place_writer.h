#pragma once
// A Place as MuJoCo and the rest of the scene know it.

#include <mujoco/mujoco.h>

#include "places/place.h"

namespace gloam {

/// Adds all of it to the spec: a body under the world for each placement, fixed or with a free
/// joint; visuals in group 2, colliders in group 3. Errors: a name that the spec has already.
Status add_place(const Place& place, mjSpec* spec);

/// Adds what MJCF cannot say, materials, lamps and the sky, before what the scene says itself.
void add_place_looks(const Place& place, Scene* scene);

/// Gives the materials that add_place_looks() added the names under which add_place() wrote them
/// into the model: a look whose name the environment uses itself is called "props/NAME" there.
void match_place_looks(const Place& place, const mjModel& model, Scene* scene);

}  // namespace gloam

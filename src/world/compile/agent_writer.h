#pragma once
// Agents as bodies of a spec: a mocap body for each rigid part, with few colliders that touch what
// moves only: MuJoCo lets neither mocap bodies nor what stands still collide with each other.

#include <mujoco/mujoco.h>

#include "gloam/result.h"
#include "gloam/scene.h"

namespace gloam {

/// Adds the bodies of all people of the scene to what is in `spec` already; vehicles, things of the
/// catalogue, are there. Doors, which open for agents, do not collide with them. Errors:
/// list_agents'; the spec has a body of that name.
Status add_agents(const Scene& scene, mjSpec* spec);

}  // namespace gloam

#pragma once
// Visible surface of a person: skin, hair, shirt, trousers and shoes as skinned meshes over the
// bodies of its parts. Shapes are this project's own; breadths follow Pheasant and Haslegrave 2006.

#include <mujoco/mujoco.h>

#include "world/agents/agent_description.h"

namespace gloam {

/// Adds materials NAME/skin … and skins of the same names. The agent's bodies must be there.
void add_person_skins(const AgentDescription& agent, mjSpec* spec);

}  // namespace gloam

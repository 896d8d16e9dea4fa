#pragma once
// Bodies of agents, which move by themselves.

#include "world/world.h"

namespace gloam {

/// The agent that a body is a part of; null = it is none's.
const AgentDescription* find_agent(const CompiledWorld& world, int body);

}  // namespace gloam

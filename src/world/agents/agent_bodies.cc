#include "world/agents/agent_bodies.h"

#include <algorithm>

namespace gloam {

const AgentDescription* find_agent(const CompiledWorld& world, int body) {
  for (const AgentDescription& agent : world.agents) {
    const auto end = agent.body.begin() + agent.parts();
    if (std::find(agent.body.begin(), end, body) != end) return &agent;
  }
  return nullptr;
}

}  // namespace gloam

#pragma once
// Decisions of an agent: its next intention.

#include "sim/agents/agent.h"

namespace gloam {

/// Surroundings as a behaviour sees them.
struct AgentSurroundings {
  const CompiledWorld& world;
  const NavWorld& nav;
  const std::vector<AgentBody>& agents;
  const std::vector<AgentSpline>& splines;  ///< by agent
  uint64_t seed = 0;
  double time = 0;  ///< [s]
  double dt = 0;    ///< since the decision before [s]
};

/// Sets the intent of the agent in that row.
void decide_intent(const AgentSurroundings& around, size_t row, AgentBody* agent);

/// Sees that the way leads to `goal`, which may be off the mesh or out of reach: then to the point
/// that is nearest to it, which is reported once. False: the agent is nowhere on the mesh.
bool find_way(const NavMesh& mesh, Vec3d goal, AgentBody* agent);

}  // namespace gloam

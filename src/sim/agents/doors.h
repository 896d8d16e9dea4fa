#pragma once
// Doors that open for agents: leaves on hinges, swung by a torque while somebody wants through.

#include <vector>

#include "sim/agents/agent.h"

namespace gloam {

class AgentDoors {
 public:
  AgentDoors(const CompiledWorld& world, const mjModel& model, const mjData& data);
  void reset();

  /// Which doors are to open, for those who are near and go towards them.
  void decide(const mjData& data, const std::vector<AgentBody>& agents);
  /// Is a door that is not yet open in the way of one who goes?
  bool is_blocked(const mjData& data, const AgentMotion& motion) const;
  /// The torques of the next step.
  void drive(mjData* data) const;
  bool empty() const { return doors_.empty(); }
  uint64_t hash(uint64_t seed) const;

 private:
  struct Door {
    int qpos = 0, dof = 0;
    double open = 0;  // angle [rad]
    Vec3d middle;     // of the opening [m]
    bool is_wanted = false, was_wanted = false;
  };
  std::vector<Door> doors_;
};

}  // namespace gloam

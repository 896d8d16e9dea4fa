#pragma once
// Doors that open for agents: leaves on hinges, swung by a torque while somebody wants through, and
// back to where they stood when nobody is near any more.

#include <span>
#include <vector>

#include "sim/agents/agent.h"

namespace gloam {

class AgentDoors {
 public:
  AgentDoors(const CompiledWorld& world, const mjModel& model, const mjData& data);
  void reset();

  /// Chooses the doors that are to open, for agents who are near and go towards them, and those
  /// that are to close; `dt`: time since the decision before [s].
  void decide(const mjData& data, const std::vector<AgentBody>& agents,
              std::span<const NavObstacle> obstacles, double dt);
  /// Is a door that is not yet open in the way of one who goes?
  bool is_blocked(const mjData& data, const AgentMotion& motion) const;
  /// The torques of the next step.
  void drive(mjData* data) const;
  bool empty() const { return doors_.empty(); }
  uint64_t hash(uint64_t seed) const;

 private:
  struct Door {
    int qpos = 0, dof = 0;
    double open = 0, rest = 0;  // angles [rad]
    Vec3d middle;               // middle of the opening [m]
    // Plain, without holes: it is hashed.
    struct State {
      double idle = 0;  // time without anybody near since it was opened [s]
      int32_t is_wanted = 0, was_opened = 0, is_closing = 0, is_driven = 0;
    } state;
  };
  std::vector<Door> doors_;
};

}  // namespace gloam

#include "gloam/joints/policy.h"
#include "policy/policy_controller.h"
#include "runtime/live/live_simulation.h"

namespace gloam {

Result<std::optional<PolicyState>> policy_state(Simulation& simulation, Robot robot) {
  auto* live = dynamic_cast<LiveSimulation*>(&simulation);
  if (live == nullptr)
    return Error{ErrorKind::kUsage, "a replay has no controllers whose state could be read"};
  std::optional<PolicyState> state;
  GLOAM_TRY_STATUS(live->simulator().read_controller(robot, [&](const Controller* controller) {
    const Controller* const own = controller != nullptr ? controller->own() : nullptr;
    if (own != nullptr) state = state_of_policy(*own);
  }));
  return state;
}

}  // namespace gloam

#include "sim/state/initial_state.h"

namespace gloam {

void reset_to_initial_state(const CompiledWorld& world, const mjModel& model, mjData& data) {
  if (world.initial_key >= 0) {
    mj_resetDataKeyframe(&model, &data, world.initial_key);
  } else {
    mj_resetData(&model, &data);
  }
}

void place_at_initial_state(const CompiledWorld& world, const mjModel& model, mjData* data) {
  reset_to_initial_state(world, model, *data);
  mj_kinematics(&model, data);
  mj_comPos(&model, data);
}

}  // namespace gloam

#include "sim/state/state_layout.h"

#include <algorithm>

namespace gloam {

StateReader::StateReader(const mjModel& model, const mjData& data) {
  auto add = [&](mjtState component, const mjtNum* from) {
    const int count = mj_stateSize(&model, component);
    if (count > 0) parts_.push_back({from, state_offset(model, component), count});
  };
  add(mjSTATE_TIME, &data.time);
  add(mjSTATE_QPOS, data.qpos);
  add(mjSTATE_QVEL, data.qvel);
  add(mjSTATE_ACT, data.act);
  add(mjSTATE_HISTORY, data.history);
  add(mjSTATE_WARMSTART, data.qacc_warmstart);
  add(mjSTATE_CTRL, data.ctrl);
  add(mjSTATE_QFRC_APPLIED, data.qfrc_applied);
  add(mjSTATE_XFRC_APPLIED, data.xfrc_applied);
  add(mjSTATE_MOCAP_POS, data.mocap_pos);
  add(mjSTATE_MOCAP_QUAT, data.mocap_quat);
  add(mjSTATE_USERDATA, data.userdata);
  add(mjSTATE_PLUGIN, data.plugin_state);
  add(mjSTATE_PLASTIC, data.plastic);
  eq_active_ = data.eq_active;
  eq_offset_ = state_offset(model, mjSTATE_EQ_ACTIVE);
  eq_count_ = mj_stateSize(&model, mjSTATE_EQ_ACTIVE);
}

void StateReader::read(double* state) const {
  for (const Part& part : parts_) std::copy_n(part.from, part.count, state + part.offset);
  std::copy_n(eq_active_, eq_count_, state + eq_offset_);
}

}  // namespace gloam

#include "sim/loop/divergence.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/state/state_layout.h"

namespace gloam {
namespace {

bool sound(double value) { return std::abs(value) <= mjMAXVAL; }  // false for NaN

std::string label(const mjModel& model, mjtObj type, const char* kind, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name != nullptr && *name != 0 ? fmt::format("{} '{}'", kind, name)
                                       : fmt::format("{} {}", kind, id);
}

}  // namespace

std::string joint_label(const mjModel& model, int joint) {
  return fmt::format("{} of {}", label(model, mjOBJ_JOINT, "joint", joint),
                     label(model, mjOBJ_BODY, "body", model.jnt_bodyid[joint]));
}

namespace {

int joint_of_qpos(const mjModel& model, int address) {
  int joint = static_cast<int>(model.njnt) - 1;
  while (joint > 0 && model.jnt_qposadr[joint] > address) --joint;
  return joint;
}

int first_unsound(std::span<const double> values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (!sound(values[i])) return static_cast<int>(i);
  }
  return -1;
}

// "the acceleration of joint 'knee' of body 'shank'": what MuJoCo complained about before the step,
// else the first number of the state after it.
std::string culprit(const mjModel& model, const mjData& data, std::span<const double> state) {
  const mjWarningStat* warning = data.warning;
  int dof = -1, address = -1;
  const char* quantity = "position";
  if (warning[mjWARN_BADQPOS].number > 0) {
    address = warning[mjWARN_BADQPOS].lastinfo;
  } else if (warning[mjWARN_BADQVEL].number > 0) {
    dof = warning[mjWARN_BADQVEL].lastinfo, quantity = "velocity";
  } else if (warning[mjWARN_BADQACC].number > 0) {
    dof = warning[mjWARN_BADQACC].lastinfo, quantity = "acceleration";
  } else if (address = first_unsound(state_part(model, state, mjSTATE_QPOS)); address < 0) {
    dof = first_unsound(state_part(model, state, mjSTATE_QVEL)), quantity = "velocity";
  }
  if (address >= 0)
    return fmt::format("the position of {}", joint_label(model, joint_of_qpos(model, address)));
  if (dof >= 0)
    return fmt::format("the {} of {}", quantity, joint_label(model, model.dof_jntid[dof]));
  const int act = first_unsound(state_part(model, state, mjSTATE_ACT));
  for (int i = 0; i < model.nactuator; ++i) {
    const int first = model.actuator_actadr[i];
    if (first >= 0 && act >= first && act < first + model.actuator_actnum[i]) {
      return fmt::format("the activation of {}", label(model, mjOBJ_ACTUATOR, "actuator", i));
    }
  }
  return "the time";
}

}  // namespace

bool is_sound(const mjModel& model, const mjData& data, std::span<const double> state) {
  if (data.warning[mjWARN_BADQPOS].number + data.warning[mjWARN_BADQVEL].number +
          data.warning[mjWARN_BADQACC].number >
      0) {
    return false;
  }
  // Time, positions, velocities and activations stand first in the state.
  const size_t n = static_cast<size_t>(1 + model.nq + model.nv + model.na);
  int unsound = 0;
  for (size_t i = 0; i < n; ++i) unsound |= sound(state[i]) ? 0 : 1;
  return unsound == 0;
}

Error describe_divergence(const mjModel& model, const mjData& data, std::span<const double> state,
                          int64_t step, double time) {
  return Error{
      ErrorKind::kDiverged,
      fmt::format("the simulation diverged in step {} (from t = {:.6g} s): {} is not finite", step,
                  time, culprit(model, data, state)),
      {},
      "reduce the timestep, or soften contacts, gains and forces"};
}

}  // namespace gloam

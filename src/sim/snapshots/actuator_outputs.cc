#include "sim/snapshots/actuator_outputs.h"

#include <algorithm>
#include <cmath>

namespace gloam {

ActuatorLaw actuator_law(const mjModel& model, const mjData& data, int actuator) {
  const int joint = model.actuator_trnid[2 * actuator];
  const double gear = model.actuator_gear[6 * model.actuator_outadr[actuator]];
  ActuatorLaw law{model.actuator_gainprm[mjNGAIN * actuator], 0};
  if (model.actuator_biastype[actuator] != mjBIAS_AFFINE) return law;
  const mjtNum* bias = model.actuator_biasprm + mjNBIAS * actuator;
  law.bias = bias[0] + bias[1] * gear * data.qpos[model.jnt_qposadr[joint]] +
             bias[2] * gear * data.qvel[model.jnt_dofadr[joint]];
  return law;
}

void take_over_control_limits(mjModel* model, mjData* data) {
  if ((model->opt.disableflags & mjDSBL_CLAMPCTRL) == 0) {
    for (int i = 0; i < model->nu; ++i)
      if (model->actuator_ctrllimited[i])
        data->ctrl[i] = std::clamp(data->ctrl[i], model->actuator_ctrlrange[2 * i],
                                   model->actuator_ctrlrange[2 * i + 1]);
  }
  model->opt.disableflags |= mjDSBL_CLAMPCTRL;
}

void set_applied_controls(std::span<const ActuatorOutputs> outputs, const mjModel& world_model,
                          mjModel* model, mjData* data) {
  model->opt.disableflags = (model->opt.disableflags & ~mjDSBL_CLAMPCTRL) |
                            (world_model.opt.disableflags & mjDSBL_CLAMPCTRL);
  if (outputs.empty()) return;
  take_over_control_limits(model, data);
  for (const ActuatorOutputs& robot : outputs) {
    for (const DriveOutput& drive : robot.drives) {
      if (!std::isfinite(drive.force)) continue;
      const ActuatorLaw law = actuator_law(*model, *data, drive.actuator);
      if (law.gain != 0)
        data->ctrl[model->actuator_ctrladr[drive.actuator]] = (drive.force - law.bias) / law.gain;
    }
  }
}

}  // namespace gloam

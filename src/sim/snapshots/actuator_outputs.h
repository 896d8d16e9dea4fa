#pragma once
// Forward passes with the forces that actuator models have applied.

#include <mujoco/mujoco.h>

#include <span>

#include "gloam/actuators.h"

namespace gloam {

/// The force of an actuator without activation on a hinge or slide: gain · control + bias.
struct ActuatorLaw {
  double gain = 0, bias = 0;
};
ActuatorLaw actuator_law(const mjModel& model, const mjData& data, int actuator);

/// Limits all controls to their ranges as MuJoCo does, and switches off MuJoCo's own limit. Then
/// controls may be set that lie outside: of position servos whose force is another than their
/// law's.
void take_over_control_limits(mjModel* model, mjData* data);

/// Before a forward pass at a Snapshot: sets the controls for which its actuators apply the forces
/// of the last step. `world_model`: has the flags of steps without actuator models.
void set_applied_controls(std::span<const ActuatorOutputs> outputs, const mjModel& world_model,
                          mjModel* model, mjData* data);

}  // namespace gloam

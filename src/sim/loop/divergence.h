#pragma once
// When physics leaves the finite numbers, and which part of the model left first.

#include <mujoco/mujoco.h>

#include <span>
#include <string>

#include "gloam/result.h"

namespace gloam {

/// "joint 'arm/elbow' of body 'arm/forearm'"; numbers where the model gives no names.
std::string joint_label(const mjModel& model, int joint);

/// True when positions, velocities and activations are numbers MuJoCo can go on with (|x| <= 1e10)
/// and it did not complain about any in the last step. `state` is that of `data`.
bool is_sound(const mjModel& model, const mjData& data, std::span<const double> state);

/// Error of kind kDiverged for a step that was not sound: names the step that failed, the time it
/// began at and the joint, body or actuator that left the finite numbers.
Error describe_divergence(const mjModel& model, const mjData& data, std::span<const double> state,
                          int64_t step, double time);

}  // namespace gloam

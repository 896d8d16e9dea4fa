#pragma once
// The arrays of mjModel and mjData by their names, from MuJoCo's own lists of them.

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// All values of a field, row by row, or those of a named element where the field's rows are of
/// elements that have names: bodies, joints (also of qpos and of degrees of freedom), actuators
/// (also of controls, activations and outputs), sensors (also of their data) and so on. Errors:
/// no such field or element, with the nearest name; a field whose rows have no names.
Result<std::vector<double>> read_field(const mjModel& model, const mjData& data,
                                       const std::string& field, const std::string& element);

/// Names of all fields.
std::vector<std::string> field_names();

}  // namespace gloam

#pragma once
// Hash of a compiled model that is the same wherever its files lie.

#include <mujoco/mujoco.h>

#include <cstdint>

namespace gloam {

/// Hash of a model with all its arrays, names and options, but without the paths of its files.
uint64_t hash_model(const mjModel& model);

}  // namespace gloam

#pragma once
// Where a simulation begins.

#include "world/world.h"

namespace gloam {

/// Resets `data` to step 0: the World's initial keyframe, or the model's default state where it has
/// none. Call it guarded.
void reset_to_initial_state(const CompiledWorld& world, const mjModel& model, mjData& data);

/// The same with the poses of bodies, and nothing else that follows from them. Call it guarded.
void place_at_initial_state(const CompiledWorld& world, const mjModel& model, mjData* data);

}  // namespace gloam

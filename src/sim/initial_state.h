#pragma once
// Where a simulation begins.

#include <span>
#include <vector>

#include "gloam/result.h"
#include "world/world.h"

namespace gloam {

/// For every robot the keyframe it starts from, or -1 for the model's default pose, (nrobot). Error
/// when a robot names a keyframe that its model does not have.
Result<std::vector<int>> find_keyframes(const CompiledWorld& world);

/// Resets `data` to step 0: the model's default state, then each robot's keyframe: positions,
/// velocities, activations and controls of that robot only; a floating base is placed relative to
/// where the scene puts the robot. A bare model's keyframe is taken whole, as stock MuJoCo does.
/// Call it guarded.
void reset_to_initial_state(const CompiledWorld& world, std::span<const int> keyframes,
                            const mjModel& model, mjData& data);

}  // namespace gloam

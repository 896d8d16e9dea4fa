#pragma once
// What a recompile keeps: the state of everything that is in both Worlds.

#include <mujoco/mujoco.h>

#include "sim/snapshots/snapshot.h"
#include "sim/state/correspondence.h"

namespace gloam {

/// Writes into `after`, which stands at its initial state, all of `before` that has a counterpart:
/// time; positions, velocities, warm start, applied forces and plastic state of joints of the same
/// type; controls, activations, histories; mocap poses, activity of equalities, external forces,
/// state of plugins; userdata where there is as much of it. What is new, or has another size, is
/// left at its initial state.
void transfer_state(const Correspondence& same, const mjData& before, mjData& after);

/// The changes that give a World the live fields of the one before: the values that had been
/// changed, of what remains. What was not changed is as the new World says.
std::vector<SetLiveField> remaining_live_fields(const Correspondence& same, const LiveFields& live);

}  // namespace gloam

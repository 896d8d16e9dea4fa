#pragma once
// Places of the vertices of a World's surfaces at an instant.

#include <span>
#include <vector>

#include "instant/surface_heights.h"

namespace gloam {

struct CompiledWorld;

/// Appends x, y, z [m] of each vertex, in the order of world/effects/surface_layout.h. `surfaces`:
/// as in a Snapshot of that `time` [s]. `scratch` is used again from call to call.
void append_surface_vertices(const CompiledWorld& world, std::span<const HeightChange> surfaces,
                             double time, std::vector<float>* scratch,
                             std::vector<float>* vertices);

}  // namespace gloam

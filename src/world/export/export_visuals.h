#pragma once
// Visible parts of a World that its model does not have, for its export.

#include <filesystem>
#include <vector>

#include "world/world.h"

namespace gloam {

/// Adds the scene's [[visual]]s and the visuals of its URDF robots to the compiled `spec` as geoms
/// of group 2 that nothing collides with and that weigh nothing; their meshes go to
/// `folder`/assets as OBJ. Their colours come along, their pictures do not: said in `left_out`.
/// Returns how many. Errors: files that cannot be written.
Result<int> add_visual_geoms(const CompiledWorld& world, const std::filesystem::path& folder,
                             mjSpec* spec, std::vector<Error>* left_out);

/// Parts of the scene that MJCF cannot express, one line a kind.
std::vector<Error> list_left_out(const Scene& scene);

}  // namespace gloam

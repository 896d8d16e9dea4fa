#pragma once
// Compiled worlds on disk, so that a second start skips meshes and hulls. An entry is found by what
// was asked for (files, options, versions) and holds good while every file it was made of still has
// the same content. A damaged entry is as good as none.

#include "world/compile/level.h"

namespace gloam {

/// Name of the entry for this scene; `place_hash` = of what is generated for it, 0 = nothing.
uint64_t world_cache_key(const Scene& scene, uint64_t place_hash = 0);

/// The scene's entry, read and checked; null when there is none that holds good.
std::shared_ptr<CompiledWorld> load_cached_world(const Scene& scene, uint64_t place_hash = 0);

/// Writes the entry while the program goes on (keep_in_cache_later).
void store_cached_world(std::shared_ptr<const CompiledWorld> world,
                        std::vector<Dependency> dependencies);

}  // namespace gloam

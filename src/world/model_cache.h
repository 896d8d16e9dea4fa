#pragma once
// Compiled worlds on disk, so that a second start skips meshes and hulls. An entry is found by what
// was asked for (files, options, versions) and holds good while every file it was made of still has
// the same content. A damaged entry is as good as none.

#include "world/level.h"

namespace gloam {

/// Name of the entry for this scene.
uint64_t world_cache_key(const Scene& scene);

/// The scene's entry, read and checked; null when there is none that holds good.
std::shared_ptr<CompiledWorld> load_cached_world(const Scene& scene);

/// Writes the entry on a thread of its own, after the program has had two seconds to start up; its
/// end waits for the entry. A cache that cannot be written is no error.
void store_cached_world(std::shared_ptr<const CompiledWorld> world,
                        std::vector<Dependency> dependencies);

/// Waits for entries that are being written. For tests and timings.
void finish_cache_writes();

}  // namespace gloam

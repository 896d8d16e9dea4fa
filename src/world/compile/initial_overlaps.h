#pragma once
// Geoms that begin inside others.

#include <vector>

#include "world/world.h"

namespace gloam {

/// Robots, and things that move, that are more than a centimetre deep in others at the beginning;
/// robots whose root is below all floors of a generated place. None for a model that is run as it
/// stands.
std::vector<Error> find_initial_overlaps(const CompiledWorld& world);

}  // namespace gloam

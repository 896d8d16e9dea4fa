#pragma once
// Names of baked patterns in the cache.

#include "render/scene/patterns/pattern_surface.h"

namespace gloam {

/// "GLOMPT01": changes with what baking gives.
inline constexpr uint64_t kPatternMagic = 0x313054504D4F4C47ull;

/// Hash of all that the baked patterns of the surfaces follow from.
uint64_t pattern_key(const PatternBaking& baking, const PatternSurfaces& found);

}  // namespace gloam

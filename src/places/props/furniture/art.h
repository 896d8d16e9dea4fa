#pragma once
// Pictures by formula: what hangs on walls, lies on floors and tables.

#include <cstdint>

#include "geometry/image/image.h"
#include "gloam/types.h"

namespace gloam {

/// A painting: hills, discs, bands or a night. sRGB.
Image8 paint_art(uint64_t seed, int width, int height);
/// A woven rug's pattern; `ground` is its display colour (sRGB).
Image8 paint_rug(uint64_t seed, int width, int height, Vec3 ground);
/// A magazine's front page.
Image8 paint_cover(uint64_t seed, int width, int height);

}  // namespace gloam

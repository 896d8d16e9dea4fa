#pragma once
// The exact channels of one tile, in lanes.

#include "render/cpu/path/tile.h"

namespace gloam {

/// Fills the film's exact channels in the tile at (x0, y0) [px]. `centers`: null, or what samples
/// through the pixels' centres have met. Returns the rays that it took.
uint64_t render_channels(const Job& job, int x0, int y0, const CenterHits* centers);

}  // namespace gloam

#pragma once
// Luminance and colour of glowing media.

#include <vector>

#include "render/kernel/media/medium_view.h"

namespace gloam {

/// Samples for BlackBodyTable, of black_body_luminance() (world/lights/black_body.h).
std::vector<Vec3f> make_black_body_table();

}  // namespace gloam

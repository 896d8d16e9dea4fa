#pragma once
// How bright and of which colour glowing media are.

#include <vector>

#include "render/kernel/media/medium_view.h"

namespace gloam {

/// What BlackBodyTable reads, of black_body_luminance() (world/lights/black_body.h).
std::vector<Vec3f> make_black_body_table();

}  // namespace gloam

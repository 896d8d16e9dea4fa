#pragma once
// Which cubes of its tables a surface touches (render/kernel/surface/baked_view.h).

#include <vector>

#include "render/scene/patterns/pattern_surface.h"

namespace gloam {

/// A triangle that has a part in the cube of a tile.
struct CubeTriangle {
  uint64_t key;  ///< baking::tile_key()
  uint32_t triangle;
};

/// All of them, by key and triangle; the surface's texel and tables are chosen.
std::vector<CubeTriangle> list_cubes(const PatternSurface& surface);

}  // namespace gloam

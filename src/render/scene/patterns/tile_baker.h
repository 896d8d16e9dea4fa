#pragma once
// Samples of a tile.

#include <span>

#include "render/kernel/surface/baked_view.h"
#include "render/kernel/surface/procedural.h"
#include "render/scene/patterns/surface_cubes.h"

namespace gloam {

BakedTexel pack_texel(const ProceduralSample& sample, float slope_u, float slope_v);
/// The same of differences of samples, as BakedDetail has them.
BakedTexel pack_difference(const ProceduralSample& sample, float slope_u, float slope_v);

/// Width of the footprint of a sample, in distances between samples: what bilinear interpolation
/// blurs by itself is left out of it.
inline constexpr float kBakedFootprint = 0.8f;

/// Fills the tile of a key of which `triangles` (not empty) have parts in its cube.
void bake_tile(const PatternSurface& surface, std::span<const CubeTriangle> triangles,
               BakedTexel* tile);

}  // namespace gloam

#pragma once
// How wide the texels of baked patterns are.

#include <array>
#include <span>

#include "render/kernel/procedural/pattern.h"
#include "render/scene/patterns/pattern_surface.h"

namespace gloam {

inline constexpr int kTexelWidths = 12;
/// Widths that texels may have [m], each twice the one before.
using TexelWidths = std::array<float, kTexelWidths>;

/// How much two samples on a surface of unit normal n differ to the eye: a square, 0 = equal.
float visible_difference(const ProceduralSample& a, const ProceduralSample& b, Vec3f n);

/// Gives all surfaces texels, tables and their first tables' numbers: as fine as about `most_tiles`
/// allow, where their patterns gain most by them; none narrower than `finest` [m].
void choose_texels(float finest, double most_tiles, std::span<PatternSurface> surfaces);

}  // namespace gloam

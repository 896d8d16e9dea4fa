#pragma once
// Maps of detail that repeat (BakedDetail).

#include <vector>

#include "render/kernel/surface/baked_view.h"
#include "world/materials/procedural_description.h"

namespace gloam {

struct DetailOrder {
  const ProceduralDescription* pattern = nullptr;
  float surface_texel = 0;  ///< of the surfaces that the detail is for [m]
  float texel = 0;          ///< about what its own are to be [m]
  int side = 0;             ///< texels, a power of two

  friend bool operator==(const DetailOrder&, const DetailOrder&) = default;
};

/// Appends the maps' texels.
BakedDetail bake_detail(const DetailOrder& order, std::vector<BakedTexel>* texels);

/// Texels that bake_detail() appends.
uint64_t detail_texels(const DetailOrder& order);

}  // namespace gloam

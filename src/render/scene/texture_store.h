#pragma once
// Textures as the kernel reads them: linear, 16 bits a channel, mip-mapped.

#include <vector>

#include "render/kernel/scene_view.h"

namespace gloam {

struct TextureStore {
  std::vector<TextureView> textures;
  std::vector<TextureLevel> levels;
  std::vector<Texel> texels;
  std::vector<bool> has_alpha;  ///< some texel is not opaque, per texture
};

/// Errors: a texture without texels, with the wrong number of faces or of texels.
Result<TextureStore> make_texture_store(const std::vector<TextureDescription>& textures);

}  // namespace gloam

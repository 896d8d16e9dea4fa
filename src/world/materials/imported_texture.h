#pragma once
// Pictures of model files as textures of the renderer, whose texels are 8 bits and repeat, mirror
// or clamp. What it cannot say (HDR texels, one channel of a picture, a cut-off) is worked out
// here.

#include <map>
#include <string>
#include <vector>

#include "geometry/image/image.h"
#include "geometry/mesh/model_file.h"
#include "world/render_description.h"

namespace gloam {

/// Source and conversion of a texture.
struct TextureRecipe {
  TextureRef source;
  bool keep_alpha = false;  ///< alpha of a colour is kept
  float cutoff = -1;        ///< >= 0: alpha is 1 from there on and 0 below
  float normal_scale = 1;   ///< scale of x and y of a normal map
};

/// The pictures of one model file, and rows of RenderDescription::textures made of them.
class ImportedTextures {
 public:
  /// Decodes the pictures that materials use, in parallel. Those that cannot be read are left out
  /// and reported. `what` names the file in reports. Error: too many pixels in all.
  static Result<ImportedTextures> decode(const ModelFile& model, const std::string& what,
                                         RenderDescription* out);

  /// The picture is there.
  bool has(const TextureRef& texture) const;
  /// Row of a texture made by the recipe, whose picture is there. It is empty until finish().
  int row(const TextureRecipe& recipe);
  /// Makes the textures of all rows handed out, in parallel.
  void finish();
  /// Mean of the texels, linear; white where there is no picture.
  Vec3f mean(const TextureRef& texture) const;
  /// It is a picture of normals, whatever it is called: bluish, and red and green average a half.
  bool looks_like_normals(const TextureRef& texture) const;

 private:
  std::vector<Image8> images_;  // by row of ModelFile::images; without texels where not read
  std::vector<std::string> names_;
  std::vector<std::pair<TextureRecipe, int>> rows_;
  RenderDescription* out_ = nullptr;
};

}  // namespace gloam

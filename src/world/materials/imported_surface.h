#pragma once
// Materials of model files as the renderer's. docs/import.md lists what becomes of what.

#include <string>

#include "world/materials/imported_texture.h"
#include "world/shapes/imported_mesh.h"

namespace gloam {

struct ImportedSurface {
  MaterialDescription material;
  UvUse uv;  ///< uvs that meshes with this material need
  /// True if MaterialDescription::bump_scale is still to be multiplied by the metres that one
  /// texture length spans, because MTL gives heights no unit.
  bool bump_by_texture = false;
};

/// `name` = its whole name. `scale` = metres of one unit of the file. Parts that are left out are
/// reported in `out`.
ImportedSurface describe_imported(const ImportedMaterial& in, const std::string& name, float scale,
                                  ImportedTextures* textures, RenderDescription* out);

/// Surface for the parts of a file that have no material.
ImportedSurface plain_surface(const std::string& name);

}  // namespace gloam

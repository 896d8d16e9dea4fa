#pragma once
// Options of a scene file for the model's materials beyond MJCF.

#include "gloam/scene.h"
#include "world/render_description.h"

namespace gloam {

/// Applies the scene's [[material]] tables to the described materials, in source order, names
/// before patterns with a *. Errors: a table that fits no material, a bump map that cannot be read,
/// colours of a material that the model itself describes.
Status author_materials(const std::vector<MaterialOptions>& options, RenderDescription* out);

/// True if a name fits a pattern, in which * stands for any text.
bool fits(std::string_view pattern, std::string_view name);

}  // namespace gloam

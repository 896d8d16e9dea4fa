#pragma once
// Surfaces of waters and soils as rows of the render description: grids of vertices that move.

#include <string>

#include "world/render_description.h"
#include "world/visual_label.h"

namespace gloam {

/// Two triangles for each square of mesh->positions, which are rows of `columns` vertices, along x,
/// one behind the other in y.
void add_grid_triangles(int columns, TriangleMesh* mesh);

/// Name of a surface: `kind` is MuJoCo's type of object, `index` its number among them.
struct SurfaceName {
  std::string name;
  int kind = 0, index = 0;
};
/// Appends a material and a deformable; `first_vertex`: of PoseFrame::vertices.
void author_surface(const SurfaceName& of, MaterialDescription material, TriangleMesh mesh,
                    int first_vertex, LabelTable* labels, RenderDescription* out);

}  // namespace gloam

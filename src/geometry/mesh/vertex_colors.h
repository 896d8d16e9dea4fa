#pragma once
// Colours at the vertices of a mesh as a picture that its material shows: the renderer has textures
// and no colours per vertex. Not for others.

#include <map>
#include <span>
#include <utility>

#include "geometry/mesh/model_source.h"

namespace gloam {

/// Pictures that paint_vertices has made of one model's meshes.
struct PaintedMeshes {
  struct Picture {
    int mesh = 0, image = -1;  ///< image -1: one colour everywhere
    Vec3f color = {1, 1, 1};
  };
  std::map<int, Picture> by_mesh;
  std::map<std::pair<int, int>, int> materials;  ///< (mesh, material) -> painted material
};

/// Gives the mesh `*mesh` its colours, linear Rec. 709 and one per position: `*mesh` becomes a copy
/// in which every triangle has a square of texels of its own whose values are an affine function,
/// so that blending them interpolates between the corners as it should. Returns the row of a copy
/// of `material` (-1 = none) multiplied by them. A material with pictures of its own keeps those
/// instead, with a note.
int paint_vertices(std::span<const Vec3f> colors, int material, int* mesh, PaintedMeshes* painted,
                   ModelFile* model);

/// 0 … 1 as a display is given it -> linear.
Vec3f color_from_display(Vec3f srgb);

}  // namespace gloam

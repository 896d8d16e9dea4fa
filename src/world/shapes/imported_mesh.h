#pragma once
// Meshes of model files as the renderer takes them: instances there are rigid, so scale, shear and
// mirroring of a node go into a copy of its mesh.

#include "geometry/mesh/imported_material.h"
#include "geometry/mesh/mesh.h"

namespace gloam {

/// X = rigid * stretch. Alike for all maps that differ by a rotation and a shift, bit for bit, so
/// that they can share one mesh.
struct RigidAndStretch {
  Affine3f rigid;         ///< a proper rotation and a shift
  Affine3f stretch;       ///< without a shift; symmetric, or any map where X has no volume
  bool is_rigid() const;  ///< the stretch does nothing
};
/// Polar decomposition (Higham 1986). X is finite.
RigidAndStretch split_stretch(const Affine3f& X);

/// Set of uvs of a mesh that textures use, and its transform.
struct UvUse {
  int set = 0;
  UvTransform transform = {};
};

/// Stretches the mesh, turns triangles of mirrored meshes round, and leaves the uvs that are used.
void bake_mesh(const Affine3f& stretch, const UvUse& uv, TriangleMesh* mesh);

/// Half of the bounding box's sides [m].
Vec3f half_extents(const TriangleMesh& mesh);

}  // namespace gloam

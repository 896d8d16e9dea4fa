#pragma once
// Meshes of physics in formats that MuJoCo does not read (GLB, glTF, COLLADA, PLY, STL as text).

#include <vector>

#include "scene/files/model_files.h"
#include "scene/files/urdf_text.h"

namespace gloam {

/// Lets MuJoCo find each copy as OBJ: the triangles of all nodes of the file at their places, in
/// Gloam's axes and metres. Errors: the file cannot be read, has no triangles.
Status add_mesh_copies(const std::vector<UrdfMeshCopy>& copies, ModelFiles* files);

}  // namespace gloam

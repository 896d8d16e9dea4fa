#pragma once
// Meshes whose triangles share no vertices get shared ones.

#include "geometry/mesh/mesh.h"

namespace gloam {

/// The mesh of triangles given by their corners, three each; corners at the very same place become
/// one vertex, numbered in the order of first use.
TriangleMesh weld(const std::vector<Vec3f>& corners);

}  // namespace gloam

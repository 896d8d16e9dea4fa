#pragma once
// Fewer triangles for much the same shape.

#include "geometry/mesh/mesh.h"

namespace gloam {

/// At most `triangles` of them, by vertices of one cell of a grid that face one way becoming one
/// where it is nearest to the planes of their triangles (Lindstrom 2000, "Out-of-core
/// simplification of large polygonal models"). Linear in time; a closed mesh stays closed, walls
/// that are thinner than a cell keep their two sides. The mesh itself where it is small enough.
/// Positions only.
TriangleMesh coarsened(const TriangleMesh& welded, size_t triangles);

}  // namespace gloam

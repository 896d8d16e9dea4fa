#pragma once
// Meshes that are made of several pieces, as exporters leave chairs and machines: pieces that are
// convex already need no search for parts.

#include <vector>

#include "geometry/mesh/mesh.h"

namespace gloam {

struct Pieces {
  std::vector<TriangleMesh> convex;  ///< hulls of closed pieces that are as good as these
  std::vector<TriangleMesh> closed;  ///< others that are closed
  TriangleMesh open;                 ///< all that are not, together; may be empty
};

/// Takes a mesh apart into pieces without common vertices. `concavity`: share of a piece's hull
/// that may be empty, as ObjectOptions::concavity. A mesh with a hollow inside stays whole.
Pieces pieces_of(const TriangleMesh& welded, double concavity);

/// Joins convex parts, those first whose common hull encloses the least that they do not, until
/// there are `most`. Takes the cube of their number in the worst case.
std::vector<TriangleMesh> merge_hulls(std::vector<TriangleMesh> hulls, size_t most);

}  // namespace gloam

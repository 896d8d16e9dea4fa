#pragma once
// Convex parts of a mesh, by CoACD (Wei et al. 2022, "Approximate convex decomposition for 3D
// meshes with collision-aware concavity and tree search").

#include <atomic>

#include "geometry/mesh/mesh.h"
#include "gloam/result.h"

namespace gloam {

struct DecomposeOptions {
  double concavity = 0.05;  ///< distance that a part may have from its hull, 0.01 … 1
  int max_hulls = 32;       ///< at most
  /// Looked at all the time. CoACD cannot be stopped: it goes on alone, to the cache; the end of
  /// the program waits for it.
  const std::atomic<bool>* is_cancelled = nullptr;
};

/// A mesh of more triangles is made coarser first (coarsen.h): the time grows with them.
inline constexpr size_t kMostDecomposed = 20'000;

/// Hulls of the parts. CoACD does not give the same parts every time, so what it gave is kept in
/// the cache, by the mesh, the options and the library. One call at a time; the library is told not
/// to print. Errors: CoACD is not installed, it finds nothing; kInterrupted.
Result<std::vector<TriangleMesh>> decompose(const TriangleMesh& welded,
                                            const DecomposeOptions& options);

}  // namespace gloam

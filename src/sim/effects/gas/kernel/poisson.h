#pragma once
// The pressure's equation on one level of the multigrid, a cell at a time. Device-safe.

#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

/// A x = sum over faces of weight (x here - x beyond). Ghosts hold 0, so that an open side of the
/// box is air at rest pressure; a closed face has weight 0.
struct PoissonView {
  Shape shape;
  Faces<const float> weight;
  const float* inverse;  ///< of the diagonal; 0 where a cell has no open face
};

GLOAM_HD float apply_poisson(const PoissonView& v, const float* x, int c) {
  const int sy = v.shape.sy, sz = v.shape.sz;
  const float here = x[c];
  return (v.weight.x[c] * (here - x[c - 1]) + v.weight.x[c + 1] * (here - x[c + 1])) +
         (v.weight.y[c] * (here - x[c - sy]) + v.weight.y[c + sy] * (here - x[c + sy])) +
         (v.weight.z[c] * (here - x[c - sz]) + v.weight.z[c + sz] * (here - x[c + sz]));
}

/// One damped Jacobi step at c.
GLOAM_HD float relax(const PoissonView& v, const float* x, const float* b, float damping, int c) {
  return x[c] + damping * v.inverse[c] * (b[c] - apply_poisson(v, x, c));
}

/// Damping of two steps that together are Chebyshev's polynomial of degree 2 on eigenvalues of
/// D⁻¹A in [0.4, 2]: those that the next level does not see.
inline constexpr float kSmooth[2] = {1.0f / (1.2f + 0.8f * 0.70710678f),
                                     1.0f / (1.2f - 0.8f * 0.70710678f)};

}  // namespace gloam::gas

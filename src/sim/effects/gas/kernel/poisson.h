#pragma once
// The pressure's equation on one level of the multigrid, a cell at a time. Device-safe.

#include <cstdint>

#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

/// A x = sum over faces of weight (x here - x beyond). Ghosts hold 0, so that an open side of the
/// box is air at rest pressure; a closed face has weight 0.
struct PoissonView {
  Shape shape;
  Faces<const float> weight;
  const float* inverse;  ///< inverse of the diagonal; 0 where a cell has no open face
};

/// Weights of a cell's faces.
struct FaceWeights {
  float xl, xh, yl, yh, zl, zh;
};

GLOAM_HD FaceWeights face_weights(const PoissonView& v, int c) {
  return {v.weight.x[c], v.weight.x[c + 1],         v.weight.y[c], v.weight.y[c + v.shape.sy],
          v.weight.z[c], v.weight.z[c + v.shape.sz]};
}

/// X: const float*, or what has values by index as that.
template <class X>
GLOAM_HD float apply_poisson(const Shape& s, const FaceWeights& w, X x, int c) {
  const float here = x[c];
  return (w.xl * (here - x[c - 1]) + w.xh * (here - x[c + 1])) +
         (w.yl * (here - x[c - s.sy]) + w.yh * (here - x[c + s.sy])) +
         (w.zl * (here - x[c - s.sz]) + w.zh * (here - x[c + s.sz]));
}

template <class X>
GLOAM_HD float apply_poisson(const PoissonView& v, X x, int c) {
  return apply_poisson(v.shape, face_weights(v, c), x, c);
}

/// Open faces of a cell, a bit each: -x +x -y +y -z +z. On the finest level this carries all that
/// the weights do in a twelfth of their memory, and a sweep is bound by memory.
GLOAM_HD uint8_t open_faces(const Faces<const float>& weight, const Shape& s, int c) {
  const auto bit = [](float w, int n) { return w > 0.0f ? 1 << n : 0; };
  return uint8_t(bit(weight.x[c], 0) | bit(weight.x[c + 1], 1) | bit(weight.y[c], 2) |
                 bit(weight.y[c + s.sy], 3) | bit(weight.z[c], 4) | bit(weight.z[c + s.sz], 5));
}

/// As apply_poisson() where weights are 1 or 0; `open`: of the cell.
template <class X>
GLOAM_HD float apply_poisson(const Shape& s, uint8_t open, X x, int c) {
  const float here = x[c];
  const auto flow = [here, open](float beyond, int n) {
    const float difference = here - beyond;
    return (open & 1 << n) != 0 ? difference : 0.0f;
  };
  return (flow(x[c - 1], 0) + flow(x[c + 1], 1)) + (flow(x[c - s.sy], 2) + flow(x[c + s.sy], 3)) +
         (flow(x[c - s.sz], 4) + flow(x[c + s.sz], 5));
}

/// Velocity that pressure takes from the face at c: half of `share` [of cells] of its gradient's
/// work.
GLOAM_HD float pressed(const float* open, const float* share, const float* x, int c, int stride) {
  return open[c] * 0.5f * (share[c] + share[c - stride]) * (x[c] - x[c - stride]);
}

/// One damped Jacobi step at c, from what the operator makes of x.
template <class X>
GLOAM_HD float relax(const PoissonView& v, X x, const float* b, float damping, float ax, int c) {
  return x[c] + damping * v.inverse[c] * (b[c] - ax);
}

/// One damped Jacobi step at c.
template <class X>
GLOAM_HD float relax(const PoissonView& v, X x, const float* b, float damping, int c) {
  return relax(v, x, b, damping, apply_poisson(v, x, c), c);
}

/// Damping of two steps that together are Chebyshev's polynomial of degree 2 on eigenvalues of
/// D⁻¹A in [0.4, 2]: those that the next level does not see.
inline constexpr float kSmooth[2] = {1.0f / (1.2f + 0.8f * 0.70710678f),
                                     1.0f / (1.2f - 0.8f * 0.70710678f)};

}  // namespace gloam::gas

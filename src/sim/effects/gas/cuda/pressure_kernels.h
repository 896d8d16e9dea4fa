#pragma once
// The parts of a projection as launches.

#include "sim/effects/gas/cuda/summing.h"
#include "sim/effects/gas/kernel/poisson.h"

namespace gloam::gas {

/// Enclosed spaces: their cells, space by space, with the space and the moving faces of each, in
/// pieces that a block each adds up.
struct EnclosedView {
  int cells, pieces, spaces;
  const int* cell;
  const int* space;        ///< space of a cell of the list
  const int* moving;       ///< faces of it
  const int* piece_begin;  ///< one more than pieces
  const int* space_begin;  ///< first of a space's pieces; one more than spaces
  const double* space_cells;
  const double* space_moving;
  double* piece_sum;
  double* space_sum;
};

/// System of equations of a projection.
struct System {
  Shape shape;
  Faces<const float> u;
  const uint8_t* open;
  const float* inverse;
  const float* wanted;
  float *x, *target, *r, *z, *p, *ap;
};

/// Takes a space's surplus from its cells: evenly, or from those at what moves, as if air leaked
/// past it.
void balance_spaces(const EnclosedView& e, const Shape& s, const Faces<const float>& u,
                    float* target, bool walls_flux, cudaStream_t stream);
void set_targets(const System& v, float scale, cudaStream_t stream);
/// r for x = 0; numbers->before = its norm.
void start_from_nothing(const System& v, const Summing& to);
/// The last solution's part is taken from r; numbers->norm.
void use_last_solution(const System& v, const Summing& to);
/// r of what x is; numbers->norm.
void find_residual(const System& v, const Summing& to);
/// An iteration of the conjugate gradients once z is preconditioned.
void iterate(const System& v, const Summing& to);
/// Takes `share` (of cells) of what x does from the velocities.
void subtract_gradient(const Shape& s, const Faces<const float>& open, const Faces<float>& velocity,
                       const float* share, const float* x, cudaStream_t stream);
/// numbers->after = norm of what is wrong with the velocities' divergence.
void find_error(const System& v, const Summing& to);
void scale(float* x, int size, float factor, cudaStream_t stream);

}  // namespace gloam::gas

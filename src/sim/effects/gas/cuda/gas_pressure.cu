#include "sim/effects/gas/cuda/launch.cuh"
#include "sim/effects/gas/cuda/pressure_kernels.h"

namespace gloam::gas {
namespace {

constexpr int kPieceThreads = 256;

__global__ void __launch_bounds__(kPieceThreads)
    piece_kernel(EnclosedView e, Shape s, Faces<const float> u, const float* target,
                 bool less_outflow) {
  __shared__ double sums[kPieceThreads];
  double sum = 0;
  const int begin = e.piece_begin[blockIdx.x], end = e.piece_begin[blockIdx.x + 1];
  for (int n = begin + int(threadIdx.x); n < end; n += kPieceThreads) {
    const int c = e.cell[n];
    sum += double(less_outflow ? target[c] - outflow(s, u, c) : target[c]);
  }
  sums[threadIdx.x] = sum;
  for (int half = kPieceThreads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (int(threadIdx.x) < half) sums[threadIdx.x] += sums[int(threadIdx.x) + half];
  }
  if (threadIdx.x == 0) e.piece_sum[blockIdx.x] = sums[0];
}

}  // namespace

/// Takes a space's surplus from its cells: evenly, or from those at what moves, as if air leaked
/// past it.
void balance_spaces(const EnclosedView& e, const Shape& s, const Faces<const float>& u,
                    float* target, bool walls_flux, cudaStream_t stream) {
  piece_kernel<<<unsigned(e.pieces), kPieceThreads, 0, stream>>>(e, s, u, target, walls_flux);
  for_range(e.spaces, stream, [e] __device__(int n) {
    double sum = 0;
    for (int p = e.space_begin[n]; p < e.space_begin[n + 1]; ++p) sum += e.piece_sum[p];
    e.space_sum[n] = sum;
  });
  for_range(e.cells, stream, [e, target, walls_flux] __device__(int n) {
    const int space = e.space[n];
    const bool leaks = walls_flux && e.space_moving[space] > 0;
    const double share = leaks ? e.moving[n] / e.space_moving[space] : 1.0 / e.space_cells[space];
    target[e.cell[n]] -= float(e.space_sum[space] * share);
  });
}

void set_targets(const System& v, float scale, cudaStream_t stream) {
  for_cells(v.shape, stream, [v, scale] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    v.target[c] = v.inverse[c] > 0.0f ? v.wanted[c] * scale : outflow(v.shape, v.u, c);
  });
}

/// r for x = 0, and its norm.
void start_from_nothing(const System& v, const Summing& to) {
  sum_cells<1>(
      v.shape, to,
      [v] __device__(int c, float(&sum)[1]) {
        const float r = v.target[c] - outflow(v.shape, v.u, c);
        v.r[c] = r;
        sum[0] += r * r;
      },
      [] __device__(CardNumbers * n, const double(&sum)[1]) {
        n->before = sqrt(sum[0]);
        n->fresh = 1;
      });
}

/// The last solution's part is taken from r.
void use_last_solution(const System& v, const Summing& to) {
  for_cells(v.shape, to.stream, [v] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    if (v.open[c] == 0) v.x[c] = 0.0f;
  });
  sum_cells<1>(
      v.shape, to,
      [v] __device__(int c, float(&sum)[1]) {
        const float r = v.r[c] - apply_poisson(v.shape, v.open[c], v.x, c);
        v.r[c] = r;
        sum[0] += r * r;
      },
      [] __device__(CardNumbers * n, const double(&sum)[1]) { n->norm = sqrt(sum[0]); });
}

/// r and its norm, of what x is.
void find_residual(const System& v, const Summing& to) {
  sum_cells<1>(
      v.shape, to,
      [v] __device__(int c, float(&sum)[1]) {
        const float r =
            v.target[c] - outflow(v.shape, v.u, c) - apply_poisson(v.shape, v.open[c], v.x, c);
        v.r[c] = r;
        sum[0] += r * r;
      },
      [] __device__(CardNumbers * n, const double(&sum)[1]) {
        n->norm = sqrt(sum[0]);
        n->fresh = 1;
      });
}

/// An iteration of the conjugate gradients once z is preconditioned.
void iterate(const System& v, const Summing& to) {
  CardNumbers* const numbers = to.numbers;
  sum_cells<1>(
      v.shape, to, [v] __device__(int c, float(&sum)[1]) { sum[0] += v.r[c] * v.z[c]; },
      [] __device__(CardNumbers * n, const double(&sum)[1]) {
        n->beta = n->fresh != 0 ? 0.0f : float(sum[0] / n->rz);
        n->rz = sum[0];
      });
  for_cells(v.shape, to.stream, [v, numbers] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    v.p[c] = numbers->fresh != 0 ? v.z[c] : v.z[c] + numbers->beta * v.p[c];
  });
  sum_cells<1>(
      v.shape, to,
      [v] __device__(int c, float(&sum)[1]) {
        const float ap = apply_poisson(v.shape, v.open[c], v.p, c);
        v.ap[c] = ap;
        sum[0] += ap * v.p[c];
      },
      [] __device__(CardNumbers * n, const double(&sum)[1]) {
        n->positive = sum[0] > 0 ? 1 : 0;
        n->alpha = n->positive != 0 ? float(n->rz / sum[0]) : 0.0f;
        n->fresh = 0;
      });
  sum_cells<1>(
      v.shape, to,
      [v, numbers] __device__(int c, float(&sum)[1]) {
        const float alpha = numbers->alpha;
        v.x[c] += alpha * v.p[c];
        const float r = v.r[c] - alpha * v.ap[c];
        v.r[c] = r;
        sum[0] += r * r;
      },
      [] __device__(CardNumbers * n, const double(&sum)[1]) { n->norm = sqrt(sum[0]); });
}

void subtract_gradient(const Shape& s, const Faces<const float>& open, const Faces<float>& velocity,
                       const float* share, const float* x, cudaStream_t stream) {
  for_faces(s, stream, [s, open, velocity, share, x] __device__(int axis, int c) {
    velocity[axis][c] -= pressed(open[axis], share, x, c, s.stride(axis));
  });
}

void find_error(const System& v, const Summing& to) {
  sum_cells<1>(
      v.shape, to,
      [v] __device__(int c, float(&sum)[1]) {
        sum[0] += sqr(v.target[c] - outflow(v.shape, v.u, c));
      },
      [] __device__(CardNumbers * n, const double(&sum)[1]) { n->after = sqrt(sum[0]); });
}

void scale(float* x, int size, float factor, cudaStream_t stream) {
  for_range(size, stream, [x, factor] __device__(int c) { x[c] *= factor; });
}

}  // namespace gloam::gas

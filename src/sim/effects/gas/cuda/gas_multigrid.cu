#include "sim/effects/gas/cuda/launch.cuh"
#include "sim/effects/gas/cuda/multigrid_kernels.h"

namespace gloam::gas {
namespace {

constexpr int kSmallThreads = 512;
constexpr int kCellsOfThread = SmallLevels::kMostCells / kSmallThreads;

__device__ float residual(const PoissonView& v, const float* x, const float* b, int c) {
  return b[c] - apply_poisson(v, x, c);
}

/// Sum of the finer cells of coarse cell (i, j, k): a lane of the warp for each of the at most 27,
/// as one thread would wait for the memory once for each. The order is that of the CPU's rows.
template <class F>
__device__ float gather(const Shape& fine, const int* const (&start)[3], int i, int j, int k, F f) {
  const int lane = int(threadIdx.x % 32);
  const int x = start[0][i] + lane / 9, y = start[1][j] + lane % 3, z = start[2][k] + lane / 3 % 3;
  const bool inside = x < start[0][i + 1] && y < start[1][j + 1] && z < start[2][k + 1];
  const float here = inside ? f(fine.at(x, y, z)) : 0.0f;
  float column = 0, sum = 0;  // first what has the same place along x
  for (int n = 0; n < 9; ++n) column += __shfl_sync(~0u, here, lane % 3 * 9 + n);
  for (int n = 0; n < 3; ++n) sum += __shfl_sync(~0u, column, n);
  return sum;
}

/// Smoothing steps [n, n + run) on a level of which `kCells` cells stay with each thread: what does
/// not change lies in registers. One warp needs no others.
template <int kCells>
__device__ void smooth_in_place(const SmallLevels& s, const Shape shape, float* own, int n, int run,
                                const Dampings& damping) {
  const int size = shape.size(), cells = shape.nx * shape.ny * shape.nz;
  const PoissonView v{shape, {own, own + size, own + 2 * size}, own + 3 * size};
  float *const x = own + 4 * size, *const b = own + 5 * size, *const t = own + 6 * size;
  const bool alone = cells <= 32;
  if (!alone || threadIdx.x < 32) {
    int at[kCells];
    FaceWeights weights[kCells];
    float inverse[kCells], wanted[kCells];
#pragma unroll
    for (int q = 0; q < kCells; ++q) {
      const int m = int(threadIdx.x) + q * kSmallThreads;
      at[q] = -1;
      if (m >= cells) continue;
      const int i = m % shape.nx, row = m / shape.nx;
      const int c = shape.at(i, row % shape.ny, row / shape.ny);
      at[q] = c, weights[q] = face_weights(v, c), inverse[q] = v.inverse[c], wanted[q] = b[c];
    }
    CycleStep next = s.works[n].step;
    for (int end = n + run; n < end; ++n) {
      const CycleStep step = next;
      if (n + 1 < end) next = s.works[n + 1].step;  // on its way while this one works
      const bool forth = step == CycleStep::kForth0 || step == CycleStep::kForth1;
      const bool second = step == CycleStep::kForth1 || step == CycleStep::kBack1;
      const float *const from = forth ? x : t, factor = second ? damping.of[1] : damping.of[0];
      float* const to = forth || step == CycleStep::kBegin ? t : x;
#pragma unroll
      for (int q = 0; q < kCells; ++q) {
        const int c = at[q];
        if (c < 0) continue;
        if (step == CycleStep::kBegin) {
          to[c] = factor * inverse[q] * wanted[q];
        } else {
          const float ax = apply_poisson(shape, weights[q], from, c);
          to[c] = from[c] + factor * inverse[q] * (wanted[q] - ax);
        }
      }
      if (alone) {
        __syncwarp();
      } else {
        __syncthreads();
      }
    }
  }
  if (alone) __syncthreads();
}

__global__ void __launch_bounds__(kSmallThreads)
    small_kernel(const __grid_constant__ SmallLevels s, int from, int to, Dampings damping) {
  extern __shared__ float values[];
  for (int l = 0; l < s.count; ++l) {
    const SmallLevels::Level& level = s.levels[l];
    const int size = level.shape.size();
    float* own = values + level.place;
    for (int n = int(threadIdx.x); n < size; n += kSmallThreads) {
      for (int a = 0; a < 3; ++a) own[a * size + n] = level.weight[a][n];
      own[3 * size + n] = level.inverse[n];
      own[4 * size + n] = own[6 * size + n] = 0.0f;
      own[5 * size + n] = l == 0 ? s.b[n] : 0.0f;
    }
  }
  __syncthreads();
  for (int n = from; n < to;) {
    const CycleWork work = s.works[n];
    const int l = work.level - s.first;
    const SmallLevels::Level& level = s.levels[l];
    const Shape fine = level.shape;
    float* own = values + level.place;
    if (work.run > 0) {
      if (fine.nx * fine.ny * fine.nz <= kSmallThreads) {
        smooth_in_place<1>(s, fine, own, n, work.run, damping);
      } else {
        smooth_in_place<kCellsOfThread>(s, fine, own, n, work.run, damping);
      }
      n += work.run;
      continue;
    }
    const int size = fine.size();
    const PoissonView v{fine, {own, own + size, own + 2 * size}, own + 3 * size};
    float *x = own + 4 * size, *b = own + 5 * size;
    const SmallLevels::Level& next = s.levels[l + 1];
    float* beyond = values + next.place;
    const bool coarser = work.step == CycleStep::kRestrict;
    const Shape over = coarser ? next.shape : fine;
    const int cells = over.nx * over.ny * over.nz, lanes = coarser ? 32 : 1;
    for (int m = int(threadIdx.x) / lanes; m < cells; m += kSmallThreads / lanes) {
      const int i = m % over.nx, row = m / over.nx, j = row % over.ny, k = row / over.ny;
      const int c = over.at(i, j, k);
      if (coarser) {
        const float sum =
            gather(fine, next.start, i, j, k, [&](int f) { return residual(v, x, b, f); });
        if (threadIdx.x % 32 == 0) beyond[5 * next.shape.size() + c] = sum;
      } else {
        const int p =
            next.shape.at(next.parent[0][i + 1], next.parent[1][j + 1], next.parent[2][k + 1]);
        x[c] += v.inverse[c] > 0.0f ? beyond[4 * next.shape.size() + p] : 0.0f;
      }
    }
    __syncthreads();
    ++n;
  }
  const int size = s.levels[0].shape.size();
  for (int n = int(threadIdx.x); n < size; n += kSmallThreads) {
    s.x[n] = values[s.levels[0].place + 4 * size + n];
  }
}

/// Result of the first step from 0.
struct FirstStep {
  const float* inverse;
  const float* b;
  float damping;
  __device__ float operator[](int c) const { return damping * inverse[c] * b[c]; }
};

/// Values around the cell at c.
struct Star {
  int c, sy, sz;
  float here, xl, xh, yl, yh, zl, zh;
  __device__ float operator[](int at) const {
    const int d = at - c;
    if (d == 0) return here;
    if (d == 1 || d == -1) return d > 0 ? xh : xl;
    if (d == sy || d == -sy) return d > 0 ? yh : yl;
    return d > 0 ? zh : zl;
  }
};

/// x and what the coarse level adds to it.
struct Prolonged {
  const float* inverse;
  const float* x;
  const float* from;
  Shape coarse;
  Axes parent;
  __device__ float at(int c, int i, int j, int k) const {
    const int p = coarse.at(parent.of[0][i + 1], parent.of[1][j + 1], parent.of[2][k + 1]);
    return x[c] + (inverse[c] > 0.0f ? from[p] : 0.0f);
  }
  __device__ Star around(const Shape& s, int i, int j, int k) const {
    const int c = s.at(i, j, k);
    return {c,
            s.sy,
            s.sz,
            at(c, i, j, k),
            at(c - 1, i - 1, j, k),
            at(c + 1, i + 1, j, k),
            at(c - s.sy, i, j - 1, k),
            at(c + s.sy, i, j + 1, k),
            at(c - s.sz, i, j, k - 1),
            at(c + s.sz, i, j, k + 1)};
  }
};

/// `open`: of the finest level, else null.
template <class X>
__device__ float relax(const PoissonView& v, const uint8_t* open, X x, const float* b,
                       float damping, int c) {
  return open != nullptr ? relax(v, x, b, damping, apply_poisson(v.shape, open[c], x, c), c)
                         : relax(v, x, b, damping, c);
}

}  // namespace

/// The finest level's weights of its cells' open faces.
void spread_open_faces(const Shape& s, const uint8_t* open, const Faces<float>& weight,
                       float* inverse, cudaStream_t stream) {
  for_faces(s, stream, [s, open, weight] __device__(int axis, int c) {
    const int here = 1 << 2 * axis, before = 2 << 2 * axis;
    weight[axis][c] =
        (open[c] & here) != 0 || (open[c - s.stride(axis)] & before) != 0 ? 1.0f : 0.0f;
  });
  for_cells(s, stream, [s, open, inverse] __device__(int i, int j, int k) {
    const int c = s.at(i, j, k);
    inverse[c] = open[c] != 0 ? 1.0f / float(__popc(open[c])) : 0.0f;
  });
}

void smooth_from_nothing(const PoissonView& v, const uint8_t* open, const float* b, float* x,
                         Dampings damping, cudaStream_t stream) {
  for_cells(v.shape, stream, [v, open, b, x, damping] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    x[c] = relax(v, open, FirstStep{v.inverse, b, damping.of[0]}, b, damping.of[1], c);
  });
}

void smooth(const PoissonView& v, const uint8_t* open, const float* b, const float* from, float* to,
            float damping, cudaStream_t stream) {
  for_cells(v.shape, stream, [v, open, b, from, to, damping] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    to[c] = relax(v, open, from, b, damping, c);
  });
}

void restrict_to(const PoissonView& v, const uint8_t* open, const float* x, const float* b,
                 const Shape& coarse, const Axes& start, float* to, cudaStream_t stream) {
  const Shape lanes{coarse.nx * 32, coarse.ny, coarse.nz, coarse.sy, coarse.sz};
  for_cells(lanes, stream, [v, open, x, b, coarse, start, to] __device__(int lane, int j, int k) {
    const int i = lane / 32;
    const float sum = gather(v.shape, start.of, i, j, k, [&](int c) {
      return open != nullptr ? b[c] - apply_poisson(v.shape, open[c], x, c) : residual(v, x, b, c);
    });
    if (lane % 32 == 0) to[coarse.at(i, j, k)] = sum;
  });
}

void prolong_and_smooth(const PoissonView& v, const uint8_t* open, const float* b, const float* x,
                        const Shape& coarse, const Axes& parent, const float* from, float* to,
                        float damping, cudaStream_t stream) {
  const Prolonged sum{v.inverse, x, from, coarse, parent};
  for_cells(v.shape, stream, [v, open, b, sum, to, damping] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    to[c] = relax(v, open, sum.around(v.shape, i, j, k), b, damping, c);
  });
}

void allow_small_levels(const SmallLevels& s) {
  must(cudaFuncSetAttribute(small_kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                            int(sizeof(float)) * s.values),
       "cannot reserve shared memory for a block");
}

void work_on_small_levels(const SmallLevels& s, int from, int to, cudaStream_t stream) {
  const size_t bytes = sizeof(float) * size_t(s.values);
  small_kernel<<<1, kSmallThreads, bytes, stream>>>(s, from, to, {{kSmooth[0], kSmooth[1]}});
}

}  // namespace gloam::gas

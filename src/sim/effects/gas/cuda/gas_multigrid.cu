#include "sim/effects/gas/cuda/launch.cuh"
#include "sim/effects/gas/cuda/multigrid_kernels.h"

namespace gloam::gas {
namespace {

constexpr int kSmallThreads = 512;

__device__ float residual(const PoissonView& v, const float* x, const float* b, int c) {
  return b[c] - apply_poisson(v, x, c);
}

/// What the finer cells of coarse cell (i, j, k) leave, in the order of the CPU's rows.
template <class F>
__device__ float gather(const Shape& fine, const int* const (&start)[3], int i, int j, int k, F f) {
  float sum = 0;
  for (int x = start[0][i]; x < start[0][i + 1]; ++x) {
    float column = 0;
    for (int z = start[2][k]; z < start[2][k + 1]; ++z) {
      for (int y = start[1][j]; y < start[1][j + 1]; ++y) column += f(fine.at(x, y, z));
    }
    sum += column;
  }
  return sum;
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
  for (int n = from; n < to; ++n) {
    const CycleWork work = s.works[n];
    const int l = work.level - s.first;
    const SmallLevels::Level& level = s.levels[l];
    const Shape fine = level.shape;
    const int size = fine.size();
    float* own = values + level.place;
    const PoissonView v{fine, {own, own + size, own + 2 * size}, own + 3 * size};
    float *x = own + 4 * size, *b = own + 5 * size, *t = own + 6 * size;
    const bool coarse = work.step == CycleStep::kRestrict;
    const SmallLevels::Level& next =
        s.levels[coarse || work.step == CycleStep::kProlong ? l + 1 : l];
    const Shape over = coarse ? next.shape : fine;
    float* beyond = values + next.place;
    const int cells = over.nx * over.ny * over.nz;
    for (int m = int(threadIdx.x); m < cells; m += kSmallThreads) {
      const int i = m % over.nx, row = m / over.nx, j = row % over.ny, k = row / over.ny;
      const int c = over.at(i, j, k);
      switch (work.step) {
        case CycleStep::kBegin:
          t[c] = damping.of[0] * v.inverse[c] * b[c];
          break;
        case CycleStep::kForth0:
          t[c] = relax(v, x, b, damping.of[0], c);
          break;
        case CycleStep::kForth1:
          t[c] = relax(v, x, b, damping.of[1], c);
          break;
        case CycleStep::kBack0:
          x[c] = relax(v, t, b, damping.of[0], c);
          break;
        case CycleStep::kBack1:
          x[c] = relax(v, t, b, damping.of[1], c);
          break;
        case CycleStep::kRestrict:
          beyond[5 * next.shape.size() + c] =
              gather(fine, next.start, i, j, k, [&](int f) { return residual(v, x, b, f); });
          break;
        case CycleStep::kProlong: {
          const int p = next.shape.at(next.parent[0][i], next.parent[1][j], next.parent[2][k]);
          x[c] += v.inverse[c] > 0.0f ? beyond[4 * next.shape.size() + p] : 0.0f;
          break;
        }
      }
    }
    __syncthreads();
  }
  const int size = s.levels[0].shape.size();
  for (int n = int(threadIdx.x); n < size; n += kSmallThreads) {
    s.x[n] = values[s.levels[0].place + 4 * size + n];
  }
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

/// to = a damped step from `from`.
void smooth(const PoissonView& v, const uint8_t* open, const float* b, const float* from, float* to,
            float damping, cudaStream_t stream) {
  if (open != nullptr) {
    for_cells(v.shape, stream, [v, open, b, from, to, damping] __device__(int i, int j, int k) {
      const int c = v.shape.at(i, j, k);
      to[c] = relax(v, from, b, damping, apply_poisson(v.shape, open[c], from, c), c);
    });
  } else {
    for_cells(v.shape, stream, [v, b, from, to, damping] __device__(int i, int j, int k) {
      const int c = v.shape.at(i, j, k);
      to[c] = relax(v, from, b, damping, c);
    });
  }
}

void restrict_to(const PoissonView& v, const uint8_t* open, const float* x, const float* b,
                 const Shape& coarse, const Axes& start, float* to, cudaStream_t stream) {
  for_cells(coarse, stream, [v, open, x, b, coarse, start, to] __device__(int i, int j, int k) {
    to[coarse.at(i, j, k)] = gather(v.shape, start.of, i, j, k, [&](int c) {
      return open != nullptr ? b[c] - apply_poisson(v.shape, open[c], x, c) : residual(v, x, b, c);
    });
  });
}

void prolong_from(const PoissonView& v, const Shape& coarse, const Axes& parent, const float* from,
                  float* x, cudaStream_t stream) {
  for_cells(v.shape, stream, [v, coarse, parent, from, x] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    const int p = coarse.at(parent.of[0][i], parent.of[1][j], parent.of[2][k]);
    x[c] += v.inverse[c] > 0.0f ? from[p] : 0.0f;
  });
}

void begin_level(const PoissonView& v, const float* b, float* t, float damping,
                 cudaStream_t stream) {
  for_cells(v.shape, stream, [v, b, t, damping] __device__(int i, int j, int k) {
    const int c = v.shape.at(i, j, k);
    t[c] = damping * v.inverse[c] * b[c];
  });
}

void allow_small_levels(const SmallLevels& s) {
  must(cudaFuncSetAttribute(small_kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                            int(sizeof(float)) * s.values),
       "a block gets too little memory");
}

void work_on_small_levels(const SmallLevels& s, int from, int to, cudaStream_t stream) {
  const size_t bytes = sizeof(float) * size_t(s.values);
  small_kernel<<<1, kSmallThreads, bytes, stream>>>(s, from, to, {{kSmooth[0], kSmooth[1]}});
}

}  // namespace gloam::gas

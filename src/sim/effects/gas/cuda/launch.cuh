#pragma once
// Loops over a grid as kernels, and sums over it in the order of rows.h: the same bits as on the
// CPU.

#include "sim/effects/gas/cuda/device_array.h"
#include "sim/effects/gas/cuda/summing.h"
#include "sim/effects/gas/kernel/shape.h"

namespace gloam::gas {

namespace launch {

inline constexpr int kSumThreads = 1024;

template <class F>
__global__ void cells_kernel(int nx, int ny, F f) {
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  const int j = int(blockIdx.y * blockDim.y + threadIdx.y);
  if (i < nx && j < ny) f(i, j, int(blockIdx.z));
}

template <class F>
__global__ void range_kernel(int n, F f) {
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < n) f(i);
}

/// A block sums a slab (k): sixteen lanes a row, added up in their order, then the rows; the last
/// block to finish adds up the slabs. `f(c, sums)` adds what cell c gives.
template <int N, class F, class G>
__global__ void __launch_bounds__(kSumThreads)
    sum_kernel(Shape s, double* slabs, CardNumbers* numbers, F f, G finish) {
  extern __shared__ double parts[];  // N times rows, then N times slabs
  const int k = int(blockIdx.x), lane = int(threadIdx.x % 16);
  const unsigned lanes = 0xFFFFu << (threadIdx.x % 32 / 16 * 16);
  for (int j = int(threadIdx.x / 16); j < s.ny; j += kSumThreads / 16) {
    float sum[N] = {};
    const int begin = s.at(0, j, k);
    for (int i = lane; i < s.nx; i += 16) f(begin + i, sum);
    for (int n = 0; n < N; ++n) {
      double row = 0;
      for (int l = 0; l < 16; ++l) row += double(__shfl_sync(lanes, sum[n], l, 16));
      if (lane == 0) parts[n * s.ny + j] = row;
    }
  }
  __syncthreads();
  if (threadIdx.x < N) {
    double sum = 0;
    for (int j = 0; j < s.ny; ++j) sum += parts[int(threadIdx.x) * s.ny + j];
    slabs[int(threadIdx.x) * s.nz + k] = sum;
    __threadfence();
  }
  __shared__ bool last;
  __syncthreads();
  if (threadIdx.x == 0) last = atomicAdd(&numbers->finished, 1u) == gridDim.x - 1;
  __syncthreads();
  if (!last) return;
  __threadfence();
  for (int i = int(threadIdx.x); i < N * s.nz; i += kSumThreads) parts[i] = __ldcg(slabs + i);
  __syncthreads();
  if (threadIdx.x != 0) return;
  double all[N];
  for (int n = 0; n < N; ++n) {
    all[n] = 0;
    for (int m = 0; m < s.nz; ++m) all[n] += parts[n * s.nz + m];
  }
  numbers->finished = 0;
  finish(numbers, all);
}

/// The largest f(c), which are at least 0; numbers->most is 0 before.
template <class F>
__global__ void __launch_bounds__(kSumThreads) most_kernel(Shape s, CardNumbers* numbers, F f) {
  __shared__ int all;
  if (threadIdx.x == 0) all = 0;
  __syncthreads();
  int most = 0;
  for (int j = int(threadIdx.x / 32); j < s.ny; j += kSumThreads / 32) {
    const int begin = s.at(0, j, int(blockIdx.x));
    for (int i = int(threadIdx.x % 32); i < s.nx; i += 32) {
      const int bits = __float_as_int(f(begin + i));
      most = bits > most ? bits : most;
    }
  }
  most = __reduce_max_sync(~0u, most);
  if (threadIdx.x % 32 == 0) atomicMax(&all, most);
  __syncthreads();
  if (threadIdx.x == 0) atomicMax(&numbers->most, all);
}

}  // namespace launch

/// Calls f(i, j, k) for each cell.
template <class F>
void for_cells(const Shape& s, cudaStream_t stream, F f) {
  const dim3 block(32, 8);
  const dim3 grid(unsigned(s.nx + 31) / 32, unsigned(s.ny + 7) / 8, unsigned(s.nz));
  launch::cells_kernel<<<grid, block, 0, stream>>>(s.nx, s.ny, f);
}

/// Calls f(axis, c) for each face across each axis.
template <class F>
void for_faces(const Shape& s, cudaStream_t stream, F f) {
  const Shape all{s.nx + 1, s.ny + 1, s.nz + 1, s.sy, s.sz};
  for_cells(all, stream, [s, f] __device__(int i, int j, int k) {
    const int c = s.at(i, j, k);
    if (j < s.ny && k < s.nz) f(0, c);
    if (i < s.nx && k < s.nz) f(1, c);
    if (i < s.nx && j < s.ny) f(2, c);
  });
}

/// Calls f(i) for i of [0, n).
template <class F>
void for_range(int n, cudaStream_t stream, F f) {
  if (n > 0) launch::range_kernel<<<unsigned(n + 255) / 256, 256, 0, stream>>>(n, f);
}

/// finish(numbers, sums) gets the N sums over the cells of what f(c, sums) adds to them.
template <int N, class F, class G>
void sum_cells(const Shape& s, const Summing& to, F f, G finish) {
  const size_t rows = size_t(N) * size_t(s.ny > s.nz ? s.ny : s.nz);
  launch::sum_kernel<N><<<unsigned(s.nz), launch::kSumThreads, rows * sizeof(double), to.stream>>>(
      s, to.slabs, to.numbers, f, finish);
}

/// numbers->most = bits of the largest f(c).
template <class F>
void find_most(const Shape& s, const Summing& to, F f) {
  must(cudaMemsetAsync(&to.numbers->most, 0, sizeof(int), to.stream), "cannot set GPU memory");
  launch::most_kernel<<<unsigned(s.nz), launch::kSumThreads, 0, to.stream>>>(s, to.numbers, f);
}

}  // namespace gloam::gas

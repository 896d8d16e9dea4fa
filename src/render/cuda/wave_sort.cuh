#pragma once
// Sorting of the surfaces that a turn of the wavefront has met, by material: what lies side by side
// is then evaluated by the same instructions.

#include "render/cuda/wave_pool.cuh"

namespace gloam::cuda {
namespace {

constexpr unsigned kSortBlocks = 512, kSortBlock = 256;

/// The part of the block of `count` elements.
struct Part {
  uint32_t begin, end;
  __device__ explicit Part(uint32_t count) {
    const uint32_t each = (count + gridDim.x - 1) / gridDim.x;
    begin = min(blockIdx.x * each, count);
    end = min(begin + each, count);
  }
};

/// Counts a part of the surfaces by bin.
__device__ __forceinline__ void count_bins(const WavePool& pool, const Part& part,
                                           uint32_t* sizes) {
  for (uint32_t k = threadIdx.x; k < kWaveBins; k += kSortBlock) sizes[k] = 0;
  __syncthreads();
  for (uint32_t i = part.begin + threadIdx.x; i < part.end; i += kSortBlock) {
    atomicAdd(&sizes[pool.met[i].bin], 1u);
  }
  __syncthreads();
}

__global__ void __launch_bounds__(kSortBlock) count_kernel(const __grid_constant__ WavePool pool) {
  __shared__ uint32_t sizes[kWaveBins];
  count_bins(pool, Part(pool.counts->met), sizes);
  for (uint32_t k = threadIdx.x; k < kWaveBins; k += kSortBlock) {
    if (sizes[k] > 0) atomicAdd(&pool.bins[k], sizes[k]);
  }
}

/// Sizes of the bins to their places, and the lengths of lists to those of the rest of the turn.
__global__ void __launch_bounds__(kWaveBins)
    scan_kernel(const __grid_constant__ WavePool pool, unsigned long long* rays, int in) {
  __shared__ uint32_t sums[kWarp];
  const uint32_t k = threadIdx.x, lane = k % kWarp, mine = pool.bins[k];
  uint32_t sum = mine;
  for (uint32_t step = 1; step < kWarp; step *= 2) {
    const uint32_t before = __shfl_up_sync(~0u, sum, step);
    if (lane >= step) sum += before;
  }
  if (lane == kWarp - 1) sums[k / kWarp] = sum;
  __syncthreads();
  for (uint32_t i = 0; i < k / kWarp; ++i) sum += sums[i];
  pool.bins[kWaveBins + k] = sum - mine;
  pool.bins[k] = 0;
  if (k > 0) return;
  WaveCounts& counts = *pool.counts;
  *rays += counts.paths[in] - counts.waiting[in] + counts.shadows[in];
  counts.paths[in] = counts.waiting[in] = counts.shadows[in] = counts.lit = 0;
  counts.sorted = counts.met;
  counts.scattering = counts.in_media;
  counts.met = counts.in_media = 0;
}

__global__ void __launch_bounds__(kSortBlock) place_kernel(const __grid_constant__ WavePool pool) {
  __shared__ uint32_t sizes[kWaveBins];
  const Part part(pool.counts->sorted);
  count_bins(pool, part, sizes);
  for (uint32_t k = threadIdx.x; k < kWaveBins; k += kSortBlock) {
    if (sizes[k] > 0) sizes[k] = atomicAdd(&pool.bins[kWaveBins + k], sizes[k]);
  }
  __syncthreads();
  for (uint32_t i = part.begin + threadIdx.x; i < part.end; i += kSortBlock) {
    const MetSurface met = pool.met[i];
    pool.sorted[atomicAdd(&sizes[met.bin], 1u)] = met.item;
  }
}

/// From `met` to `sorted`; the turn's rays are counted.
inline void sort_surfaces(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  count_kernel<<<kSortBlocks, kSortBlock, 0, stream>>>(w.pool);
  scan_kernel<<<1, kWaveBins, 0, stream>>>(w.pool, p.film.rays, w.in());
  place_kernel<<<kSortBlocks, kSortBlock, 0, stream>>>(w.pool);
}

}  // namespace
}  // namespace gloam::cuda

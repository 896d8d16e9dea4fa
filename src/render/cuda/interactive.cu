// Kernels of the interactive tier: pictures into one.
#include "render/cuda/interactive_kernels.h"
#include "render/kernel/interactive/temporal_light.h"
#include "render/kernel/interactive/temporal_restore.h"

namespace gloam::cuda {
namespace {

constexpr int kColumns = 32, kRows = 8;

__device__ bool pixel_of(const TemporalPicture& p, int* x, int* y) {
  *x = static_cast<int>(blockIdx.x * kColumns + threadIdx.x);
  *y = static_cast<int>(blockIdx.y * kRows + threadIdx.y);
  return *x < p.width && *y < p.height;
}

__global__ void accumulate_kernel(const __grid_constant__ TemporalPicture p) {
  int x, y;
  if (pixel_of(p, &x, &y)) temporal::accumulate(p, x, y);
}

__global__ void settle_kernel(const __grid_constant__ TemporalPicture p) {
  int x, y;
  if (pixel_of(p, &x, &y)) temporal::settle(p, x, y);
}

__global__ void compose_kernel(const __grid_constant__ TemporalPicture p) {
  int x, y;
  if (pixel_of(p, &x, &y)) temporal::compose(p, x, y);
}

__global__ void details_kernel(const __grid_constant__ TemporalPicture p) {
  int x, y;
  if (pixel_of(p, &x, &y)) temporal::add_details(p, x, y);
}

__global__ void sum_kernel(const __grid_constant__ TemporalPicture p) {
  const auto i = static_cast<int>(blockIdx.x * kColumns * kRows + threadIdx.x);
  if (i < p.block_columns() * p.block_rows())
    temporal::sum_block(p, i % p.block_columns(), i / p.block_columns());
}

__global__ void restore_kernel(const __grid_constant__ TemporalPicture p) {
  int x, y;
  if (pixel_of(p, &x, &y)) temporal::restore(p, x, y);
}

}  // namespace

void launch_temporal(const TemporalPicture& p, Stream stream) {
  const dim3 threads(kColumns, kRows);
  const dim3 blocks(static_cast<unsigned>((p.width + kColumns - 1) / kColumns),
                    static_cast<unsigned>((p.height + kRows - 1) / kRows));
  accumulate_kernel<<<blocks, threads, 0, stream>>>(p);
  settle_kernel<<<blocks, threads, 0, stream>>>(p);
  compose_kernel<<<blocks, threads, 0, stream>>>(p);
  details_kernel<<<blocks, threads, 0, stream>>>(p);
  constexpr int kThreads = kColumns * kRows;
  const int sums = p.block_columns() * p.block_rows();
  sum_kernel<<<static_cast<unsigned>((sums + kThreads - 1) / kThreads), kThreads, 0, stream>>>(p);
  restore_kernel<<<blocks, threads, 0, stream>>>(p);
}

}  // namespace gloam::cuda

// Kernels of the paths that measure the ambient light, for any scene.
#include "render/cuda/kernels.h"

namespace gloam::cuda {
namespace {

constexpr int kWarp = 32;

/// Tracer as one function for several places that trace: these paths are few. The first ray is the
/// camera's.
struct CalledTracer {
  const DevicePicture& p;
  mutable bool is_first = true;

  __device__ __noinline__ bool trace(const Ray& ray, bool any, RayHit* hit) const {
    const bool clips = is_first && !p.clip.is_idle();
    is_first = false;
    return clips ? trace_in_view(p.scene, p.tracer, p.camera, p.clip, ray, hit)
                 : p.tracer.trace(ray, any, hit);
  }
  __device__ bool closest(const Ray& ray, bool active, bool, RayHit* hit) const {
    return active && trace(ray, false, hit);
  }
  __device__ bool occluded(const Ray& ray, bool active) const {
    RayHit hit;
    return active && trace(ray, true, &hit);
  }
};

__global__ void __launch_bounds__(kWarp)
    ambient_kernel(const __grid_constant__ DevicePicture p, AmbientPath* paths) {
  const uint32_t i = blockIdx.x * kWarp + threadIdx.x;
  paths[i] =
      ambient_path(p.scene, CalledTracer{p}, p.camera, p.width, p.height, p.path.max_depth, i);
}

/// A warp for each facing; sums in a fixed order.
__global__ void __launch_bounds__(kWarp* LightGuide::kFacings)
    mean_kernel(const AmbientPath* paths, AmbientCube* ambient) {
  __shared__ AmbientSum sums[LightGuide::kFacings];
  const int facing = static_cast<int>(threadIdx.x) / kWarp;
  float sum[4] = {};
  for (int i = static_cast<int>(threadIdx.x) % kWarp; i < 1 << kLog2AmbientPaths; i += kWarp) {
    const AmbientPath path = paths[i];
    if (path.facing != facing) continue;
    for (int c = 0; c < 3; ++c) sum[c] += path.light[c];
    sum[3] += 1;
  }
  for (float& value : sum) {
    for (int step = kWarp / 2; step > 0; step /= 2) value += __shfl_down_sync(~0u, value, step);
  }
  if (threadIdx.x % kWarp == 0) sums[facing] = {{sum[0], sum[1], sum[2]}, sum[3]};
  __syncthreads();
  if (threadIdx.x > 0) return;
  AmbientSum all;
  for (const AmbientSum& one : sums) {
    all.light += one.light;
    all.count += one.count;
  }
  *ambient = mean_ambient(sums, all);
}

}  // namespace

void launch_ambient(const DevicePicture& p, AmbientPath* paths, AmbientCube* ambient,
                    Stream stream) {
  ambient_kernel<<<(1u << kLog2AmbientPaths) / kWarp, kWarp, 0, stream>>>(p, paths);
  mean_kernel<<<1, kWarp * LightGuide::kFacings, 0, stream>>>(paths, ambient);
}

}  // namespace gloam::cuda

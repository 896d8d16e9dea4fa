// Kernel of the paths that measure the ambient light, for any scene.
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

}  // namespace

void launch_ambient(const DevicePicture& p, AmbientPath* paths, Stream stream) {
  ambient_kernel<<<(1u << kLog2AmbientPaths) / kWarp, kWarp, 0, stream>>>(p, paths);
}

}  // namespace gloam::cuda

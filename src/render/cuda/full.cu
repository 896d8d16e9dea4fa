// The kernels of any scene, and the choice between them and the plain ones.
#include "render/cuda/kernels.cuh"

namespace gloam::cuda {

void launch_plain_path(const DevicePicture& p, Stream stream);
void launch_plain_direct(const DevicePicture& p, Stream stream);
void launch_plain_channels(const DevicePicture& p, bool unknown_alone, Stream stream);

namespace {

/// Few paths, but with several places that trace: one function for all.
struct CalledTracer {
  const BvhTracer& tracer;

  __device__ __noinline__ bool trace(const Ray& ray, bool any, RayHit* hit) const {
    return tracer.trace(ray, any, hit);
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
  paths[i] = ambient_path(p.scene, CalledTracer{p.tracer}, p.camera, p.width, p.height,
                          p.path.max_depth, i);
}

}  // namespace

void launch_path(const DevicePicture& p, Stream stream) {
  if (p.plain) return launch_plain_path(p, stream);
  path_kernel<<<blocks_for(p, p.split), kBlock, 0, stream>>>(p);
}
void launch_direct(const DevicePicture& p, Stream stream) {
  if (p.plain) return launch_plain_direct(p, stream);
  direct_kernel<<<blocks_for(p, 1), kBlock, 0, stream>>>(p);
}
void launch_channels(const DevicePicture& p, bool unknown_alone, Stream stream) {
  if (p.plain) return launch_plain_channels(p, unknown_alone, stream);
  channels_kernel<<<blocks_for(p, 1), kBlock, 0, stream>>>(p, unknown_alone);
}
void launch_ambient(const DevicePicture& p, AmbientPath* paths, Stream stream) {
  ambient_kernel<<<(1u << kLog2AmbientPaths) / kWarp, kWarp, 0, stream>>>(p, paths);
}

}  // namespace gloam::cuda

// Stage of the wavefront that evaluates surfaces.
#define GLOAM_KERNELS_WITHOUT_MEDIA
#include "render/cuda/wave_pool.cuh"

namespace gloam::cuda {
namespace {

/// The shadow ray goes on behind the surface, or ends there.
__device__ void pass_shadow(const DevicePicture& p, const WaveTurn& w, uint32_t slot,
                            const Surface& s, paths::ShadowWalk walk) {
  if (!paths::pass_surface(s, &walk)) {
    if (!(max_component(walk.arriving) > 0)) {
      w.pool.in_shadow[slot] = 0;
      return;
    }
    walk.ray.tmax = 0;  // the light lies within rounding
  }
  cast_shadow(p, w, slot, walk);
}

__global__ void __launch_bounds__(kBlock, kBlocks)
    surface_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WaveTurn w) {
  const WavePool& pool = w.pool;
  const uint32_t count = pool.counts->sorted;
  for (uint32_t i = blockIdx.x * kBlock + threadIdx.x; i < count; i += w.blocks * kBlock) {
    const uint32_t item = pool.sorted[i], slot = item >> 1;
    const bool by_shadow = (item & 1u) != 0;
    paths::ShadowWalk walk;
    Ray ray;
    RayHit hit;
    RayCone cone;
    if (by_shadow) {
      walk = pool.shadow.load(slot);
      ray = walk.ray;
      hit = pool.shadow_hit.load(slot);
    } else {
      const paths::State<float> path = pool.path.load(slot);
      ray = path.ray;
      hit = pool.hit.load(slot);
      cone = {path.cone_width, path.cone_spread};
    }
    const Surface s = make_surface<float>(p.scene, ray, hit, cone);
    if (by_shadow) {
      pass_shadow(p, w, slot, s, walk);
    } else {
      pool.surface.store(slot, s);
    }
  }
}

}  // namespace

void launch_wave_surfaces(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  surface_kernel<<<w.blocks, kBlock, 0, stream>>>(p, w);
}

}  // namespace gloam::cuda

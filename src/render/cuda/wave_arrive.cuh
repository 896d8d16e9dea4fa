#pragma once
// Stage of the wavefront that adds the light along segments and lists the surfaces at their ends.

#include "render/cuda/wave_pool.cuh"

namespace gloam::cuda {
namespace {

__global__ void __launch_bounds__(kBlock, kBlocks)
    arrive_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WaveTurn w) {
  const WavePool& pool = w.pool;
  const uint32_t count = pool.counts->paths[w.in()];
  for (uint32_t i = blockIdx.x * kBlock + threadIdx.x; i < count; i += w.blocks * kBlock) {
    const uint32_t slot = pool.paths[w.in()][i] & ~kTraced;
    if (pool.in_shadow[slot] != 0) {
      pool.paths[w.out()][append(&pool.counts->paths[w.out()])] = slot | kTraced;
      append(&pool.counts->waiting[w.out()]);
      continue;
    }
    paths::State<float> path = pool.path.load(slot);
    path.light_sampler.keep_in(pool.lights + slot);
    RayHit hit = pool.hit.load(slot);
    const Vec3f before = path.result.radiance;
    const paths::ArrivalOf<float> at = paths::arrive(p.scene, p.path, &path, true, hit.t >= 0, hit);
    if (p.scene.has_media()) {
      pool.path.store(slot, path);
    } else if (!(path.result.radiance == before)) {
      pool.path.store(slot, path, kResult, kResult + sizeof before);
    }
    if (at.medium_vertex.scattered) {
      hit.t = at.medium_vertex.t;
      hit.instance = at.medium_vertex.volume;
      pool.hit.store(slot, hit);
      pool.in_media[append(&pool.counts->in_media)] = slot;
    } else if (at.found) {
      meet_surface(p, pool, slot, false, hit.instance);
    }
  }
}

}  // namespace
}  // namespace gloam::cuda

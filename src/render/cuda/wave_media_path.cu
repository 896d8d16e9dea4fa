// Stages of the wavefront in scenes with media.
#include "render/cuda/wave_arrive.cuh"

namespace gloam::cuda {
namespace {

__global__ void __launch_bounds__(kBlock, kBlocks)
    lit_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WaveTurn w) {
  const WavePool& pool = w.pool;
  const uint32_t count = pool.counts->lit;
  for (uint32_t i = blockIdx.x * kBlock + threadIdx.x; i < count; i += w.blocks * kBlock) {
    const uint32_t slot = pool.lit[i];
    paths::State<float> path = pool.path.load(slot);
    paths::add_shadow_light(p.scene, pool.shadow.load(slot), &path);
    pool.path.store(slot, path);
  }
}

__global__ void __launch_bounds__(kBlock, kBlocks)
    media_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WaveTurn w) {
  const WavePool& pool = w.pool;
  const uint32_t count = pool.counts->scattering;
  for (uint32_t i = blockIdx.x * kBlock + threadIdx.x; i < count; i += w.blocks * kBlock) {
    const uint32_t slot = pool.in_media[i];
    paths::State<float> path = pool.path.load(slot);
    const RayHit hit = pool.hit.load(slot);
    paths::SegmentEndOf<float> at;
    paths::ArrivalOf<float> arrival;
    arrival.medium_vertex = {true, hit.t, hit.instance};
    paths::meet(p.scene, p.path, arrival, &path, &at);
    const bool goes_on =
        at.scatters && scatter(p, w, slot, &path, [&](paths::NextEventOf<float>* event) {
          return paths::sample_in_media(p.scene, p.path, at.medium_vertex, &path, event);
        });
    pool.path.store(slot, path);
    if (goes_on) go_on(w, slot);
  }
}

}  // namespace

void launch_wave_arrive_through_media(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  arrive_kernel<<<w.blocks, kBlock, 0, stream>>>(p, w);
}
void launch_wave_lit(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  lit_kernel<<<w.blocks, kBlock, 0, stream>>>(p, w);
}
void launch_wave_scatter_in_media(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  media_kernel<<<w.blocks, kBlock, 0, stream>>>(p, w);
}

}  // namespace gloam::cuda

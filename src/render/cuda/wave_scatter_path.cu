// Stage of the wavefront that samples lights and directions at surfaces.
#define GLOAM_KERNELS_WITHOUT_MEDIA
#include "render/cuda/wave_pool.cuh"

namespace gloam::cuda {
namespace {

constexpr int kScatterBlocks = 3;  ///< on a multiprocessor: 168 registers a thread

/// In the order of `met`, which is almost that of the slots: whole cache lines of states count for
/// more here than like materials side by side.
__global__ void __launch_bounds__(kBlock, kScatterBlocks)
    scatter_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WaveTurn w) {
  const WavePool& pool = w.pool;
  const uint32_t count = pool.counts->sorted;
  for (uint32_t i = blockIdx.x * kBlock + threadIdx.x; i < count; i += w.blocks * kBlock) {
    const uint32_t item = pool.met[i].item, slot = item >> 1;
    if ((item & 1u) != 0) continue;  // a shadow ray's
    paths::State<float> path = pool.path.load(slot);
    path.light_sampler.keep_in(pool.lights + slot);
    paths::SegmentEndOf<float> at;
    at.v = pool.surface.load(slot);
    paths::ArrivalOf<float> arrival;
    arrival.found = true;
    paths::meet(p.scene, p.path, arrival, &path, &at);
    bool goes_on = at.through;
    if (at.scatters) {
      goes_on = scatter(p, w, slot, &path, [&](paths::NextEventOf<float>* event) {
        return paths::sample_at_surface(p.scene, p.path, at.v, &path, event);
      });
    }
    if (goes_on || keeps_for_media(p)) {
      pool.path.store(slot, path);
    } else {
      pool.path.store(slot, path, kResult, kResult + sizeof path.result);
    }
    if (goes_on) go_on(w, slot);
  }
}

}  // namespace

void launch_wave_scatter(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  scatter_kernel<<<w.blocks, kBlock, 0, stream>>>(p, w);
}

}  // namespace gloam::cuda

// The wavefront's rays, and its loop over turns.
#include "render/cuda/wavefront.h"

#include <algorithm>
#include <cstddef>

#include "render/cuda/wave_sort.cuh"

namespace gloam::cuda {
namespace {

/// Paths at once, at most: enough to fill the card many times over, in three gigabytes.
constexpr uint32_t kMostSlots = 1u << 22;
constexpr int kTraceBlocks = 8;  ///< on a multiprocessor: 64 registers a thread
/// Blocks of the kernels of late turns, in which few paths are left.
constexpr unsigned kLateBlocks = 1024;
constexpr int kEarlyTurns = 4;  ///< turns in which every path may be alive

/// Part of a picture whose samples all have a slot: tiles of 8 x 4 pixels, of each tile all
/// samples, of each sample the 32 pixels. Pictures of several worlds would follow each other as
/// their tiles do.
struct WaveBatch {
  uint32_t first_tile = 0, tiles = 0;
  uint32_t slots(const DevicePicture& p) const {
    return tiles * static_cast<uint32_t>(p.samples) * kWarp;
  }
};

__device__ __forceinline__ Place place_in(const DevicePicture& p, uint32_t tile, uint32_t lane) {
  const uint32_t columns = static_cast<uint32_t>((p.width + kTileWidth - 1) / kTileWidth);
  Place at;
  at.x = static_cast<int>(tile % columns * kTileWidth + lane % kTileWidth);
  at.y = static_cast<int>(tile / columns * kTileHeight + lane / kTileWidth);
  at.group = 0;
  at.inside = at.x < p.width && at.y < p.height;
  return at;
}

__global__ void __launch_bounds__(kBlock)
    start_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WavePool pool,
                 WaveBatch batch) {
  const uint32_t slot = blockIdx.x * kBlock + threadIdx.x, samples = p.samples;
  if (slot >= batch.tiles * samples * kWarp) return;
  const Place at = place_in(p, batch.first_tile + slot / kWarp / samples, slot % kWarp);
  paths::State<float> path;
  bool starts = false;
  if (at.inside) {
    RayCone cone;
    Sampler sampler;
    const int sample = p.first_sample + static_cast<int>(slot / kWarp % samples);
    const Ray ray = sample_ray(p, at, sample, false, &cone, &sampler);
    starts = sees(ray);
    path.start({ray, cone.width, cone.spread, sampler}, true);
  }
  pool.path.store(slot, path);
  if (starts) pool.paths[0][append(&pool.counts->paths[0])] = slot;
}

/// Ends or continues a shadow ray that has been traced. `hit`: null where no light can pass.
__device__ __forceinline__ void end_shadow(const DevicePicture& p, const WavePool& pool,
                                           uint32_t slot, bool found, const RayHit* hit) {
  const SceneView& scene = p.scene;
  const bool passes = found && hit != nullptr &&
                      scene.materials[scene.instances[hit->instance].material].transparent;
  if (scene.lets_light_through()) pool.in_shadow[slot] = passes ? 1 : 0;
  if (passes) {
    pool.shadow_hit.store(slot, *hit);
    meet_surface(p, pool, slot, true, hit->instance);
  } else if (!found && scene.has_media()) {
    pool.lit[append(&pool.counts->lit)] = slot;
  } else if (!found) {
    const Vec3f arriving = pool.shadow.load(slot).arriving;
    static_assert(kResult % sizeof(float4) == 0);
    constexpr uint32_t kRadiance = kResult / sizeof(float4);
    float4& radiance = pool.path.pieces[kRadiance * pool.path.slots + slot];
    float4 sum = radiance;
    sum.x += arriving.x;
    sum.y += arriving.y;
    sum.z += arriving.z;
    radiance = sum;
  }
}

/// The turn's shadow rays and the rays of its paths. kCamera: the latter come from the camera, and
/// there are no others.
template <bool kCamera>
__global__ void __launch_bounds__(kBlock, kTraceBlocks)
    trace_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WaveTurn w) {
  const WavePool& pool = w.pool;
  const uint32_t shadows = kCamera ? 0 : pool.counts->shadows[w.in()];
  const uint32_t first = (shadows + kWarp - 1) / kWarp * kWarp;  // path: warps have one kind
  const uint32_t count = first + pool.counts->paths[w.in()];
  for (uint32_t i = blockIdx.x * kBlock + threadIdx.x; i < count; i += w.blocks * kBlock) {
    const bool is_shadow = i < first;
    if (is_shadow && i >= shadows) continue;
    const uint32_t slot = is_shadow ? pool.shadows[w.in()][i] : pool.paths[w.in()][i - first];
    if ((slot & kTraced) != 0) continue;
    Ray ray;
    bool any = false;
    if (is_shadow) {
      const paths::ShadowWalk walk = pool.shadow.load(slot);
      ray = walk.ray;
      any = walk.passed == 0;  // behind a surface, others are met one by one
    } else {
      ray = pool.path.load(slot).ray;
    }
    RayHit hit;
    bool found, again;
    do {
      bool clear;
      found = p.tracer.trace(p.scene, ray, any, &hit, &clear);
      again = clear && !found;
      any = any && !again;
    } while (again);
    if (is_shadow) {
      end_shadow(p, pool, slot, found, any ? nullptr : &hit);
      continue;
    }
    if (kCamera) found = clip_first(p, ray, found, &hit);
    if (!found) hit.t = -1;
    pool.hit.store(slot, hit);
  }
}

/// Samples of a pixel are added in their order.
__global__ void __launch_bounds__(kBlock)
    mean_kernel(const __grid_constant__ DevicePicture p, const __grid_constant__ WavePool pool,
                WaveBatch batch) {
  const uint32_t i = blockIdx.x * kBlock + threadIdx.x, tile = i / kWarp, samples = p.samples;
  if (tile >= batch.tiles) return;
  const Place at = place_in(p, batch.first_tile + tile, i % kWarp);
  if (!at.inside) return;
  PixelMean mean;
  for (uint32_t k = 0; k < samples; ++k) {
    mean.add(pool.path.load((tile * samples + k) * kWarp + i % kWarp).result);
  }
  store_mean(p, at.pixel(p.width), mean);
}

unsigned blocks_for_threads(uint32_t threads) { return (threads + kBlock - 1) / kBlock; }

/// Lays out a pool from `at` on; with `at` null, `used` is what it takes.
struct Layout {
  char* at;
  size_t used = 0;

  template <class T>
  void place(T** array, size_t count) {
    *array = at == nullptr ? nullptr : reinterpret_cast<T*>(at + used);
    used += (count * sizeof(T) + 255) / 256 * 256;
  }
  template <class T>
  void place(SlotArray<T>* array, uint32_t slots) {
    array->slots = slots;
    place(&array->pieces, size_t{slots} * SlotArray<T>::kPieces);
  }
};

WavePool lay_out(Layout* layout, const SceneView& scene, uint32_t slots) {
  WavePool pool;
  pool.slots = slots;
  layout->place(&pool.counts, 1);
  layout->place(&pool.bins, 2 * kWaveBins);
  layout->place(&pool.in_shadow, slots);
  layout->place(&pool.path, slots);
  layout->place(&pool.shadow, slots);
  layout->place(&pool.hit, slots);
  layout->place(&pool.surface, slots);
  layout->place(&pool.sorted, 2 * size_t{slots});
  layout->place(&pool.met, 2 * size_t{slots});
  for (int k = 0; k < 2; ++k) {
    layout->place(&pool.paths[k], slots);
    layout->place(&pool.shadows[k], slots);
  }
  if (!scene.has_many_lights()) layout->place(&pool.lights, slots);
  if (scene.lets_light_through()) layout->place(&pool.shadow_hit, slots);
  if (scene.has_media()) {
    layout->place(&pool.lit, slots);
    layout->place(&pool.in_media, slots);
  }
  return pool;
}

void run_turn(const DevicePicture& p, const WaveTurn& w, Stream stream) {
  const bool has_media = p.scene.has_media();
  if (w.turn == 0) {
    trace_kernel<true><<<w.blocks, kBlock, 0, stream>>>(p, w);
  } else {
    trace_kernel<false><<<w.blocks, kBlock, 0, stream>>>(p, w);
  }
  if (has_media) {
    launch_wave_lit(p, w, stream);
    launch_wave_arrive_through_media(p, w, stream);
  } else {
    launch_wave_arrive(p, w, stream);
  }
  sort_surfaces(p, w, stream);
  launch_wave_surfaces(p, w, stream);
  launch_wave_scatter(p, w, stream);
  if (has_media) launch_wave_scatter_in_media(p, w, stream);
}

/// Whether a turn may have left paths or shadow rays.
bool has_more(const WaveTurn& w, WaveCounts* counts, Stream stream) {
  check(cudaMemcpyAsync(counts, w.pool.counts, sizeof *counts, cudaMemcpyDeviceToHost, stream),
        "cannot copy from the GPU");
  check(cudaStreamSynchronize(stream), "a CUDA kernel failed");
  return counts->paths[w.out()] + counts->shadows[w.out()] > 0;
}

void run_batch(const DevicePicture& p, const WavePool& pool, const WaveBatch& batch,
               WaveCounts* counts, Stream stream) {
  const size_t zeros = reinterpret_cast<char*>(pool.path.pieces) -
                       reinterpret_cast<char*>(pool.counts);  // counts, bins, in_shadow
  check(cudaMemsetAsync(pool.counts, 0, zeros, stream), "cannot set GPU memory");
  const unsigned all = blocks_for_threads(batch.slots(p));
  start_kernel<<<all, kBlock, 0, stream>>>(p, pool, batch);
  // Without surfaces that rays pass, each turn is a segment.
  const int segments = std::max(p.path.max_depth, 1);
  WaveTurn w{pool, 0, all};
  for (;; ++w.turn) {
    const int turns = w.turn + 1;
    w.blocks = turns <= kEarlyTurns ? all : std::min(all, kLateBlocks);
    run_turn(p, w, stream);
    if (turns == segments && !p.scene.lets_light_through()) break;
    const bool may_end = turns <= segments ? turns % 8 == 0 : (turns - segments) % 4 == 2;
    if (may_end && !has_more(w, counts, stream)) break;
  }
  mean_kernel<<<blocks_for_threads(batch.tiles * kWarp), kBlock, 0, stream>>>(p, pool, batch);
}

}  // namespace

void Wavefront::render(const DevicePicture& p, Stream stream) {
  const auto parts = [](int pixels, int each) {
    return static_cast<uint32_t>((pixels + each - 1) / each);
  };
  const uint32_t tiles = parts(p.width, kTileWidth) * parts(p.height, kTileHeight);
  const uint32_t of_tile = static_cast<uint32_t>(p.samples) * kWarp;
  const uint32_t most = std::max(kMostSlots / of_tile, 1u), batches = (tiles + most - 1) / most;
  const uint32_t each = (tiles + batches - 1) / batches;
  Layout layout{nullptr};
  lay_out(&layout, p.scene, each * of_tile);
  layout = {static_cast<char*>(pool_.reserve(layout.used))};
  const WavePool pool = lay_out(&layout, p.scene, each * of_tile);
  auto* const counts = reinterpret_cast<WaveCounts*>(counts_.reserve(sizeof(WaveCounts)));
  for (uint32_t first = 0; first < tiles; first += each) {
    run_batch(p, pool, {first, std::min(each, tiles - first)}, counts, stream);
  }
}

}  // namespace gloam::cuda

#pragma once
// Paths of a wavefront in the card's memory, and the launches of its stages.

#include <cstddef>

#include "render/cuda/pixels.cuh"
#include "render/kernel/path/path_machine.h"

namespace gloam::cuda {

/// One structure per slot, in pieces of 16 bytes: neighbours have equal pieces side by side.
template <class T>
struct SlotArray {
  static constexpr uint32_t kPieces = (sizeof(T) + sizeof(float4) - 1) / sizeof(float4);
  float4* pieces = nullptr;
  uint32_t slots = 0;

  __device__ __forceinline__ T load(uint32_t slot) const {
    float4 bytes[kPieces];
#pragma unroll
    for (uint32_t k = 0; k < kPieces; ++k) bytes[k] = pieces[k * slots + slot];
    T value;
    memcpy(&value, bytes, sizeof(T));
    return value;
  }
  /// Stores the pieces that hold the bytes from `begin` to `end`.
  __device__ __forceinline__ void store(uint32_t slot, const T& value, size_t begin = 0,
                                        size_t end = sizeof(T)) const {
    float4 bytes[kPieces] = {};
    memcpy(bytes, &value, sizeof(T));
#pragma unroll
    for (uint32_t k = 0; k < kPieces; ++k) {
      if ((k + 1) * sizeof(float4) > begin && k * sizeof(float4) < end)
        pieces[k * slots + slot] = bytes[k];
    }
  }
};

/// Lengths of the lists. Those in pairs are read in one turn and written for the next.
struct WaveCounts {
  uint32_t paths[2], shadows[2];
  uint32_t waiting[2];            ///< of `paths`, those that are not traced again
  uint32_t met;                   ///< surfaces that this turn's rays have met
  uint32_t sorted;                ///< the same, once they are sorted
  uint32_t lit;                   ///< shadow rays that have arrived, in media
  uint32_t in_media, scattering;  ///< vertices in media, and the same once the turn's are complete
};

/// Where the light of a path is in its state.
inline constexpr size_t kResult = offsetof(paths::State<float>, result);

/// A path of `WavePool::paths` that has met its surface and waits for its shadow ray.
inline constexpr uint32_t kTraced = 1u << 31;
/// Rows of materials that are told apart when surfaces are sorted, at most.
inline constexpr uint32_t kWaveBins = 1024;

struct MetSurface {
  uint32_t item;  ///< slot, and in the lowest bit whether its shadow ray has met the surface
  uint32_t bin;
};

struct WavePool {
  uint32_t slots = 0;
  SlotArray<paths::State<float>> path;
  SlotArray<paths::ShadowWalk> shadow;
  SlotArray<RayHit> hit, shadow_hit;  ///< t < 0: none. Of vertices in media: their t, and as the
                                      ///< instance the row of their volume
  SlotArray<Surface> surface;
  LightProbabilitiesOf<float>* lights = nullptr;  ///< of the path's last vertex
  uint8_t* in_shadow = nullptr;  ///< whether the shadow ray is on its way through surfaces
  uint32_t *paths[2] = {}, *shadows[2] = {}, *lit = nullptr, *in_media = nullptr;  ///< slots
  MetSurface* met = nullptr;
  uint32_t* sorted = nullptr;  ///< items of `met`
  uint32_t* bins = nullptr;    ///< sizes of the bins, then where their next surface goes
  WaveCounts* counts = nullptr;
};

/// Arguments of all kernels of one turn.
struct WaveTurn {
  WavePool pool;
  int turn = 0;
  unsigned blocks = 0;  ///< on the grid
  GLOAM_HD int in() const { return turn & 1; }
  GLOAM_HD int out() const { return 1 - in(); }
};

/// Row for one element more of a list: order does not matter, because each path is its own.
__device__ __forceinline__ uint32_t append(uint32_t* count) {
  const unsigned lanes = __activemask(), lane = threadIdx.x % 32;
  const int leader = __ffs(static_cast<int>(lanes)) - 1;
  uint32_t first = 0;
  if (static_cast<int>(lane) == leader) first = atomicAdd(count, __popc(lanes));
  return __shfl_sync(lanes, first, leader) + __popc(lanes & ((1u << lane) - 1u));
}

/// Puts a surface on the list of those to be evaluated.
__device__ __forceinline__ void meet_surface(const DevicePicture& p, const WavePool& pool,
                                             uint32_t slot, bool by_shadow, uint32_t instance) {
  const uint32_t bin = p.scene.instances[instance].material % kWaveBins;
  pool.met[append(&pool.counts->met)] = {slot << 1 | (by_shadow ? 1u : 0u), bin};
}

/// Kernels for surfaces know nothing of media; some of what they keep is for media alone.
__device__ __forceinline__ bool keeps_for_media(const DevicePicture& p) {
  return p.scene.media.volumes.size > 0;
}

/// Stores the shadow ray and puts it on the list of the next turn.
__device__ __forceinline__ void cast_shadow(const DevicePicture& p, const WaveTurn& w,
                                            uint32_t slot, const paths::ShadowWalk& walk) {
  w.pool.shadow.store(slot, walk, 0,
                      keeps_for_media(p) ? sizeof walk : offsetof(paths::ShadowWalk, length));
  w.pool.shadows[w.out()][append(&w.pool.counts->shadows[w.out()])] = slot;
}

/// The same for light that has been sampled. Light that casts no shadow has arrived.
__device__ __forceinline__ void cast_shadow(const DevicePicture& p, const WaveTurn& w,
                                            uint32_t slot, const paths::NextEventOf<float>& event) {
  paths::ShadowWalk walk = paths::ShadowWalk::of(event);
  if (!event.casts_shadow) walk.ray.tmax = 0;
  cast_shadow(p, w, slot, walk);
}

/// Keeps the probabilities of lights at the path's vertex for the end of its next segment.
__device__ __forceinline__ void keep_lights(const SceneView& scene, const WavePool& pool,
                                            uint32_t slot,
                                            const LightProbabilitiesOf<float>& probabilities) {
  if (scene.has_many_lights() || !scene.has_emitters) return;  // no ray will ask for them
  float4* const to = reinterpret_cast<float4*>(pool.lights[slot].of);
  const float* from = probabilities.of;
  for (uint32_t i = 0; i < scene.lights.size; i += 4) {
    to[i / 4] = {from[i], from[i + 1], from[i + 2], from[i + 3]};
  }
}

/// Samples light and a direction at a vertex of the path with `sample(&event)`, and casts the
/// shadow ray. Returns whether the path goes on.
template <class Sample>
__device__ __forceinline__ bool scatter(const DevicePicture& p, const WaveTurn& w, uint32_t slot,
                                        paths::State<float>* path, const Sample& sample) {
  LightProbabilitiesOf<float> probabilities;
  path->light_sampler.keep_in(&probabilities);
  paths::NextEventOf<float> event;
  const bool goes_on = sample(&event);
  if (goes_on) keep_lights(p.scene, w.pool, slot, probabilities);
  if (event.lit) cast_shadow(p, w, slot, event);
  return goes_on;
}

/// Puts a path on the list of the next turn.
__device__ __forceinline__ void go_on(const WaveTurn& w, uint32_t slot) {
  w.pool.paths[w.out()][append(&w.pool.counts->paths[w.out()])] = slot;
}

/// Surfaces of `sorted`: those of paths are kept, shadow rays go on behind theirs.
void launch_wave_surfaces(const DevicePicture& p, const WaveTurn& w, Stream stream);
/// Sorts the ends of path segments without media: light, and surfaces to be evaluated.
void launch_wave_arrive(const DevicePicture& p, const WaveTurn& w, Stream stream);
/// Light and directions at the same surfaces, in the order of `met`.
void launch_wave_scatter(const DevicePicture& p, const WaveTurn& w, Stream stream);
// The same where there are media, of shadow rays that have arrived, and in media.
void launch_wave_arrive_through_media(const DevicePicture& p, const WaveTurn& w, Stream stream);
void launch_wave_lit(const DevicePicture& p, const WaveTurn& w, Stream stream);
void launch_wave_scatter_in_media(const DevicePicture& p, const WaveTurn& w, Stream stream);

}  // namespace gloam::cuda

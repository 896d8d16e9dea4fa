#pragma once
// The kernels: pixels to threads. All shading and traversal is that of render/kernel.

#include "render/cuda/kernels.h"
#include "render/kernel/direct.h"
#include "render/kernel/path_machine.h"
#include "render/kernel/pixel_mean.h"

#ifndef GLOAM_CUDA_BLOCKS
#define GLOAM_CUDA_BLOCKS 4  // of 128 threads on a multiprocessor: 128 registers a thread
#endif

namespace gloam::cuda {
namespace {  // each of the files that include this has kernels of its own

constexpr int kBlock = 128, kWarp = 32, kWarps = kBlock / kWarp;
constexpr int kTileWidth = 8, kTileHeight = 4;  ///< pixels of a warp

/// Pixel of a thread when each tile of 8 x 4 has one warp, or `split` warps of a block.
struct Place {
  int x, y, group;  ///< group: of samples, of `split`
  bool inside;
  __device__ size_t pixel(int width) const { return static_cast<size_t>(y) * width + x; }
};
__device__ __forceinline__ Place place_of(int width, int height, int split) {
  const int warp = threadIdx.x / kWarp, lane = threadIdx.x % kWarp;
  const int columns = (width + kTileWidth - 1) / kTileWidth;
  const int tile = blockIdx.x * (kWarps / split) + warp / split;
  Place p;
  p.x = tile % columns * kTileWidth + lane % kTileWidth;
  p.y = tile / columns * kTileHeight + lane / kTileWidth;
  p.group = warp % split;
  p.inside = p.x < width && p.y < height;
  return p;
}
inline unsigned blocks_for(const DevicePicture& p, int split) {
  const int tiles =
      (p.width + kTileWidth - 1) / kTileWidth * ((p.height + kTileHeight - 1) / kTileHeight);
  return static_cast<unsigned>((tiles * split + kWarps - 1) / kWarps);
}

/// Whole numbers: the order of the sums does not matter.
__device__ __forceinline__ void count_rays(const DeviceFilm& film, uint32_t rays) {
  for (int step = kWarp / 2; step > 0; step /= 2) rays += __shfl_down_sync(~0u, rays, step);
  if (threadIdx.x % kWarp == 0) atomicAdd(film.rays, static_cast<unsigned long long>(rays));
}

__device__ __forceinline__ Ray sample_ray(const DevicePicture& p, const Place& at, int sample,
                                          bool centered, RayCone* cone, Sampler* sampler) {
  *sampler =
      Sampler::make(p.seed, p.frame, static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y),
                    static_cast<uint32_t>(sample), p.log2_samples);
  Vec2f offset, lens;
  float time = 0;
  if (!centered) {
    offset = sample_pixel_filter(sampler->next_2d());
    if (p.has_motion) time = p.camera.time_of(at.y, sampler->next_1d());
    if (p.camera.has_aperture()) lens = sampler->next_2d();
  }
  return camera_ray(p.camera, static_cast<float>(at.x) + 0.5f + offset.x,
                    static_cast<float>(at.y) + 0.5f + offset.y, time, cone, &lens);
}

/// The mean of this launch into the film, after that of earlier ones.
__device__ __forceinline__ void store_mean(const DevicePicture& p, size_t pixel, PixelMean mean) {
  const DeviceFilm& film = p.film;
  if (p.done > 0) {
    PixelMean before;
    before.radiance = film.radiance[pixel];
    before.albedo = film.albedo[pixel];
    before.normal = film.normal[pixel];
    if (film.squares != nullptr) before.squares = film.squares[pixel];
    before.count = p.done;
    before.merge(mean);
    mean = before;
  }
  film.radiance[pixel] = mean.radiance;
  film.albedo[pixel] = mean.albedo;
  film.normal[pixel] = mean.normal;
  if (film.squares != nullptr) film.squares[pixel] = p.last ? mean.variance() : mean.squares;
}

__device__ __forceinline__ void store_channels(const DeviceFilm& film, size_t pixel,
                                               const ExactChannels& c) {
  film.depth[pixel] = c.depth;
  film.distance[pixel] = c.distance;
  film.part[pixel] = c.part;
  if (film.center_normal == nullptr) return;
  film.center_normal[pixel] = c.normal;
  film.center_albedo[pixel] = c.albedo;
  film.motion[pixel] = c.motion;
  film.scene_flow[pixel] = c.scene_flow;
}

/// Each warp has a tile's pixels and a share of their samples; the warps of a tile meet in shared
/// memory, in order.
__global__ void __launch_bounds__(kBlock, GLOAM_CUDA_BLOCKS)
    path_kernel(const __grid_constant__ DevicePicture p) {
  __shared__ PixelMean shares[kBlock];
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, p.split);
  PixelMean mean;
  uint32_t rays = 0;
  if (at.inside) {
    const int end = p.samples * (at.group + 1) / p.split;
    int next = p.samples * at.group / p.split;
    PathMachine path;
    // A lane whose path has ended starts the next at once: it does not wait for its warp.
    for (bool running = false; running || next < end;) {
      if (!running) {
        RayCone cone;
        Sampler sampler;
        const Ray ray = sample_ray(p, at, p.first_sample + next++, false, &cone, &sampler);
        if (!sees(ray)) {
          mean.add({});
          continue;
        }
        path.start(ray, cone, sampler);
      }
      RayHit hit;
      const bool found = p.tracer.trace(path.ray(), path.any_hit(scene), &hit);
      running = path.advance(scene, p.path, found, hit);
      if (running) continue;
      mean.add(path.result());
      rays += path.result().rays;
    }
  }
  count_rays(p.film, rays);
  if (p.split > 1) {
    shares[threadIdx.x] = mean;
    __syncthreads();
    if (at.group > 0) return;
    for (int k = 1; k < p.split; ++k) mean.merge(shares[threadIdx.x + k * kWarp]);
  }
  if (at.inside) store_mean(p, at.pixel(p.width), mean);
}

__global__ void __launch_bounds__(kBlock, GLOAM_CUDA_BLOCKS)
    direct_kernel(const __grid_constant__ DevicePicture p) {
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, 1);
  uint32_t rays = 0;
  if (at.inside) {
    const size_t pixel = at.pixel(p.width);
    PixelMean mean;
    for (int i = 0; i < p.samples; ++i) {
      RayCone cone;
      Sampler sampler;
      const Ray ray = sample_ray(p, at, p.first_sample + i, p.centered, &cone, &sampler);
      DirectState state;
      direct_start(&state, ray, cone, sampler);
      RayHit hit;
      bool found;
      do {
        found = p.tracer.trace(state.ray, state.any, &hit);
      } while (direct_advance(scene, &state, found, hit));
      mean.add(sees(ray) ? state.result : PathResult{});
      rays += state.result.rays;
      if (!p.centered || p.film.part == nullptr) continue;
      const bool known = state.layers == 0 || (state.layers == 1 && state.has_first);
      if (!known) {
        p.film.part[pixel] = kUnknownPart;
      } else if (!state.has_first) {
        store_channels(p.film, pixel, describe_sky(p.camera, ray));
      } else {
        const Surface s = make_surface<float>(scene, ray, state.first, cone);
        if (shows(scene, s)) {
          store_channels(p.film, pixel, describe_surface(scene, p.camera, ray, s, state.first));
        } else {
          p.film.part[pixel] = kUnknownPart;
        }
      }
    }
    store_mean(p, pixel, mean);
  }
  count_rays(p.film, rays);
}

__global__ void __launch_bounds__(kBlock, GLOAM_CUDA_BLOCKS)
    channels_kernel(const __grid_constant__ DevicePicture p, bool unknown_alone) {
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, 1);
  uint32_t rays = 0;
  const size_t pixel = at.pixel(p.width);
  if (at.inside && (!unknown_alone || p.film.part[pixel] == kUnknownPart)) {
    RayCone cone;
    const float time = p.has_motion ? p.camera.time_of(at.y, 0) : 0.0f;
    const Ray ray = camera_ray(p.camera, static_cast<float>(at.x) + 0.5f,
                               static_cast<float>(at.y) + 0.5f, time, &cone);
    Surface s;
    RayHit hit;
    const bool found = find_first(scene, p.tracer, ray, cone, &s, &hit, &rays);
    store_channels(
        p.film, pixel,
        found ? describe_surface(scene, p.camera, ray, s, hit) : describe_sky(p.camera, ray));
  }
  count_rays(p.film, rays);
}

}  // namespace
}  // namespace gloam::cuda

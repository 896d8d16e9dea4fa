#pragma once
// Pixels to threads, and helpers of all kernels. All shading and traversal is that of
// render/kernel.

#include "render/cuda/kernels.h"
#include "render/kernel/camera/pixel_mean.h"

namespace gloam::cuda {
namespace {  // each of the files that include this has kernels of its own

constexpr int kBlock = 128, kWarp = 32, kWarps = kBlock / kWarp;
/// Blocks on a multiprocessor: 128 registers a thread; of the short kernel of plain paths 64.
constexpr int kBlocks = 4, kPlainPathBlocks = 8;
constexpr int kTileWidth = 8, kTileHeight = 4;  ///< pixels of a warp

/// Pixel of a thread when each tile of 8 x 4 has one warp, or `split` warps of a block.
struct Place {
  int x, y, group;  ///< group: of samples, of `split`
  bool inside;
  __device__ size_t pixel(int width) const { return static_cast<size_t>(y) * width + x; }
};

/// The rows of tiles from the middle of the picture to its rims. What takes long is mostly in the
/// middle; where the whole picture takes little longer, it must not start last.
__device__ __forceinline__ int from_the_middle(int i, int count) {
  return count / 2 + (i % 2 == 0 ? i / 2 : -(i + 1) / 2);
}
__device__ __forceinline__ Place place_of(int width, int height, int split, bool middle_first) {
  const int warp = threadIdx.x / kWarp, lane = threadIdx.x % kWarp;
  const int columns = (width + kTileWidth - 1) / kTileWidth;
  const int rows = (height + kTileHeight - 1) / kTileHeight;
  const int tile = blockIdx.x * (kWarps / split) + warp / split;
  Place p;
  p.x = tile % columns * kTileWidth + lane % kTileWidth;
  const int row = tile / columns;
  p.y = (middle_first ? from_the_middle(row, rows) : row) * kTileHeight + lane / kTileWidth;
  p.group = warp % split;
  p.inside = tile < columns * rows && p.x < width && p.y < height;
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
    if (!kPlainScenes && p.has_motion) time = p.camera.time_of(at.y, sampler->next_1d());
    if (p.camera.has_aperture()) lens = sampler->next_2d();
  }
  return camera_ray(p.camera, static_cast<float>(at.x) + 0.5f + offset.x,
                    static_cast<float>(at.y) + 0.5f + offset.y, time, cone, &lens);
}

/// Behind a hit that the picture's camera does not see, the first that it sees. Rare, and one
/// function for all places that trace: another traversal in a kernel would crowd its registers.
__device__ __noinline__ bool trace_past(const DevicePicture& p, const Ray& ray, RayHit* hit) {
  return trace_in_view(p.scene, p.tracer, p.camera, p.clip, ray, hit);
}

/// Whether the picture's camera sees the first hit of its ray.
__device__ __forceinline__ bool is_in_view(const DevicePicture& p, const Ray& ray,
                                           const RayHit& hit) {
  return hit.t >= p.clip.start(p.camera, ray) && !p.clip.passes<float>(p.scene, ray, hit, true);
}
/// The same as a function: placing the surface would crowd the registers of plain kernels.
__device__ __noinline__ bool called_is_in_view(const DevicePicture& p, const Ray& ray,
                                               const RayHit& hit) {
  return is_in_view(p, ray, hit);
}

/// First surface that a ray of the camera sees: `found` and `hit` are the first that it meets.
__device__ __forceinline__ bool clip_first(const DevicePicture& p, const Ray& ray, bool found,
                                           RayHit* hit) {
  if (!found || p.clip.is_idle()) return found;
  const bool is_seen = kPlainScenes ? called_is_in_view(p, ray, *hit) : is_in_view(p, ray, *hit);
  return is_seen || trace_past(p, ray, hit);
}

/// Traces the camera's ray first, then others.
struct ViewTracer {
  const DevicePicture& p;
  mutable bool is_first = true;

  __device__ bool trace(const Ray& ray, bool any, RayHit* hit) const {
    const bool found = p.tracer.trace(ray, any, hit);
    const bool clips = is_first;
    is_first = false;
    return clips ? clip_first(p, ray, found, hit) : found;
  }
};

// A film goes past the caches: no kernel reads it while there is room to keep, and the tree needs
// that room.
template <class T>
__device__ __forceinline__ void put(T* at, T value) {
  __stcs(at, value);
}
__device__ __forceinline__ void put(Vec2f* at, Vec2f v) {
  __stcs(&at->x, v.x);
  __stcs(&at->y, v.y);
}
__device__ __forceinline__ void put(Vec3f* at, Vec3f v) {
  __stcs(&at->x, v.x);
  __stcs(&at->y, v.y);
  __stcs(&at->z, v.z);
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
  put(film.radiance + pixel, mean.radiance);
  put(film.albedo + pixel, mean.albedo);
  put(film.normal + pixel, mean.normal);
  if (film.squares != nullptr) put(film.squares + pixel, p.last ? mean.variance() : mean.squares);
}

}  // namespace
}  // namespace gloam::cuda

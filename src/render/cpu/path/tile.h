#pragma once
// One tile of a picture, and the inputs of a render call.

#include <immintrin.h>

#include "render/cpu/path/watch.h"
#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/camera/channels.h"
#include "render/kernel/camera/pixel_mean.h"
#include "render/kernel/path/path.h"
#include "render/renderer.h"
#include "render/slices.h"

namespace gloam {

inline constexpr int kTile = 16;  // [px]

/// Denormals are zero while a tile is rendered, whatever thread does it.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

/// One render call: everything that its pixels share.
struct Job {
  SceneView scene;
  CpuTracer tracer;
  CameraView32 camera;
  RenderSettings settings;
  PathOptions path;
  uint32_t log2_samples = 0;
  bool has_motion = false;  ///< something moves while the shutter is open
  /// A single direct sample, the first of its pixel, goes through the pixel's centre and serves the
  /// exact channels too.
  bool centered = false;
  Film* film = nullptr;
  RenderWatch* watch = nullptr;  ///< asked between samples whether to go on; null = to the end
  bool may_continue() const { return watch == nullptr || watch->may_continue(); }
  RenderSlices* slices = nullptr;
};

/// Pixel `index` of a full tile: 4 x 4 blocks, so that packets of primary rays are compact.
inline void tile_pixel(int index, int* x, int* y) {
  const int block = index / 16, in = index % 16;
  *x = block % (kTile / 4) * 4 + in % 4;
  *y = block / (kTile / 4) * 4 + in / 4;
}

/// Hits of rays through the centres of a tile's pixels, in tile_pixel()'s order.
struct CenterHits {
  bool known[kTile * kTile] = {}, found[kTile * kTile] = {};
  RayHit hits[kTile * kTile];
};

template <class State>
struct Wave;

/// Samples first … first + count - 1 of the sequence that `seed` scrambles.
struct SampleRange {
  uint64_t seed = 1;
  int first = 0, count = 0;
};

/// One tile's pixels inside the picture, and their running means.
class Tile {
 public:
  Tile(const Job& job, int x0, int y0) : Tile(job, x0, y0, [](int) { return true; }) {}
  /// Tile of the pixels i (see tile_pixel) that `wanted` takes.
  template <class Wanted>
  Tile(const Job& job, int x0, int y0, const Wanted& wanted) : job_(job) {
    for (int i = 0; i < kTile * kTile; ++i) {
      int x, y;
      tile_pixel(i, &x, &y);
      if (x0 + x >= job.film->width || y0 + y >= job.film->height || !wanted(i)) continue;
      index_[count_] = i;
      x_[count_] = x0 + x;
      y_[count_] = y0 + y;
      ++count_;
    }
  }

  /// Adds samples of the path tier to the means.
  void render_path(const SampleRange& range);
  /// Renders all samples of the direct tier. Those that are centred serve the exact channels too.
  void render_direct(CenterHits* centers);
  void store_means(RenderStats* stats) const;

  int count() const { return count_; }
  int index(int i) const { return index_[i]; }  ///< in the full tile
  size_t pixel_of(int i) const { return static_cast<size_t>(y_[i]) * job_.film->width + x_[i]; }
  PixelMean& mean(int i) { return mean_[i]; }
  uint64_t rays() const { return rays_; }

 private:
  void trace_paths(const SampleRange& range, PathResult* results);
  paths::CameraSampleOf<FloatLanes> camera_sample(const SampleRange& range, const int* path_of,
                                                  MaskLanes* seeing) const;
  template <class State, class Start, class Advance, class Finish>
  void sample(Wave<State>* wave, int index, const Start& start, const Advance& advance,
              const Finish& finish);
  Ray pixel_ray(int i, Vec2f offset, float time, RayCone* cone, const Vec2f* lens) const {
    return camera_ray(job_.camera, static_cast<float>(x_[i]) + 0.5f + offset.x,
                      static_cast<float>(y_[i]) + 0.5f + offset.y, time, cone, lens);
  }

  const Job& job_;
  int count_ = 0;
  uint64_t rays_ = 0;
  int x_[kTile * kTile], y_[kTile * kTile], index_[kTile * kTile];
  PixelMean mean_[kTile * kTile];
  bool sees_[kTile * kTile];
};

}  // namespace gloam

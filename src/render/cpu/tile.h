#pragma once
// One tile of a picture: its paths in lanes, or in waves of single rays traced in packets.

#include <immintrin.h>

#include <algorithm>
#include <memory>

#include "render/cpu/embree_tracer.h"
#include "render/kernel/channels.h"
#include "render/kernel/direct.h"
#include "render/renderer.h"

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
  EmbreeTracer tracer;
  CameraView32 camera;
  RenderSettings settings;
  PathOptions path;
  uint32_t log2_samples = 0;
  bool has_motion = false;  ///< something moves while the shutter is open
  /// A single direct sample goes through the pixel's centre, and serves the exact channels too.
  bool centered = false;
  Film* film = nullptr;
};

/// Mean over the samples of a pixel and the variance of that mean (Welford 1962).
struct PixelMean {
  Vec3f radiance, squares, albedo, normal;
  int count = 0;

  void add(const PathResult& sample) {
    ++count;
    const float weight = 1.0f / static_cast<float>(count);
    const Vec3f delta = sample.radiance - radiance;
    radiance += delta * weight;
    squares += delta * (sample.radiance - radiance);
    albedo += (sample.albedo - albedo) * weight;
    normal += (sample.normal - normal) * weight;
  }
  Vec3f variance() const {
    return count < 2 ? Vec3f{} : squares / (static_cast<float>(count) * (count - 1));
  }
};

inline void store_channels(Film* film, size_t pixel, const ExactChannels& c) {
  film->depth[pixel] = c.depth;
  film->distance[pixel] = c.distance;
  film->part[pixel] = c.part;
  film->center_normal[pixel] = c.normal;
  film->center_albedo[pixel] = c.albedo;
  film->motion[pixel] = c.motion;
}

/// The paths of one sample of a tile, run together: each round traces all of their rays in packets,
/// then advances every path.
template <class State>
struct Wave {
  State states[kTile * kTile];
  RayHit hits[kTile * kTile];
  bool found[kTile * kTile];
  int alive[kTile * kTile];
  int count = 0;

  /// The closest hit of each path in `alive`.
  void trace_closest(const EmbreeTracer& tracer) { trace_kind(tracer, false, true); }

  template <class Advance>
  void run(const SceneView& scene, const EmbreeTracer& tracer, const Advance& advance) {
    for (int i = 0; i < count; ++i) alive[i] = i;
    for (bool first_round = true; count > 0; first_round = false) {
      trace_kind(tracer, false, first_round);
      trace_kind(tracer, true, false);
      int left = 0;
      const int all = count;
      for (int i = 0; i < all; ++i) {
        if (i + 2 * kAhead < all) fetch_instance(scene, alive[i + 2 * kAhead]);
        if (i + kAhead < all) fetch_triangle(scene, alive[i + kAhead]);
        const int k = alive[i];
        if (advance(&states[k], found[k], hits[k])) alive[left++] = k;
      }
      count = left;
    }
  }

 private:
  /// Paths between a request to the memory for what a hit needs and its use.
  static constexpr int kAhead = 4;

  bool needs_surface(int k) const { return found[k] && !states[k].any; }
  void fetch_instance(const SceneView& scene, int k) const {
    if (!needs_surface(k)) return;
    const char* instance = reinterpret_cast<const char*>(&scene.instances[hits[k].instance]);
    for (size_t byte = 0; byte < sizeof(InstanceView); byte += 64) {
      __builtin_prefetch(instance + byte);
    }
  }
  void fetch_triangle(const SceneView& scene, int k) const {
    if (!needs_surface(k)) return;
    const InstanceView& instance = scene.instances[hits[k].instance];
    const char* material = reinterpret_cast<const char*>(&scene.materials[instance.material]);
    __builtin_prefetch(material);
    __builtin_prefetch(material + 64);
    if (instance.shape != ShapeType::kMesh) return;
    const MeshView& mesh = scene.meshes[instance.mesh];
    const size_t triangle = hits[k].primitive;
    if (!mesh.corner_normals.empty()) {
      __builtin_prefetch(mesh.corner_normals.data + 3 * triangle);
      __builtin_prefetch(mesh.corner_normals.data + 3 * triangle + 2);
    }
    if (!mesh.uvs.empty()) __builtin_prefetch(mesh.uvs.data + triangle);
    __builtin_prefetch(mesh.indices.data + 3 * triangle);
  }

  void trace_kind(const EmbreeTracer& tracer, bool any, bool coherent) {
    constexpr int n = EmbreeTracer::kPacket;
    const Ray* rays[n];
    int who[n], used = 0;
    RayHit packet_hits[n];
    bool packet_found[n];
    const auto flush = [&] {
      if (used == 0) return;
      tracer.trace_packet(rays, used, any, coherent, packet_hits, packet_found);
      for (int j = 0; j < used; ++j) {
        found[who[j]] = packet_found[j];
        if (packet_found[j] && !any) hits[who[j]] = packet_hits[j];
      }
      used = 0;
    };
    for (int i = 0; i < count; ++i) {
      const int k = alive[i];
      if (states[k].any != any) continue;
      rays[used] = &states[k].ray;
      who[used++] = k;
      if (used == n) flush();
    }
    flush();
  }
};

/// Pixel `index` of a full tile: 4 x 4 blocks, so that packets of primary rays are compact.
inline void tile_pixel(int index, int* x, int* y) {
  const int block = index / 16, in = index % 16;
  *x = block % (kTile / 4) * 4 + in % 4;
  *y = block / (kTile / 4) * 4 + in / 4;
}

struct CenterState {
  Ray ray;
  bool any = false;
};

/// One tile's pixels inside the picture, and their running means.
class Tile {
 public:
  Tile(const Job& job, int x0, int y0) : job_(job) {
    for (int i = 0; i < kTile * kTile; ++i) {
      int x, y;
      tile_pixel(i, &x, &y);
      if (x0 + x >= job.film->width || y0 + y >= job.film->height) continue;
      x_[count_] = x0 + x;
      y_[count_] = y0 + y;
      ++count_;
    }
  }

  template <class State, class Start, class Advance, class Finish>
  void sample(Wave<State>* wave, int index, const Start& start, const Advance& advance,
              const Finish& finish) {
    const RenderSettings& settings = job_.settings;
    wave->count = count_;
    for (int i = 0; i < count_; ++i) {
      Sampler sampler = Sampler::make(
          settings.seed, settings.frame, static_cast<uint32_t>(x_[i]), static_cast<uint32_t>(y_[i]),
          static_cast<uint32_t>(settings.first_sample + index), job_.log2_samples);
      Vec2f offset;
      float time = 0;
      if (!job_.centered) {
        offset = sample_pixel_filter(sampler.next_2d());
        if (job_.has_motion) time = sampler.next_1d();
      }
      RayCone cone;
      const Ray ray = center_ray(i, offset, time, &cone);
      start(&wave->states[i], ray, cone, sampler);
    }
    wave->run(job_.scene, job_.tracer, advance);
    for (int i = 0; i < count_; ++i) {
      mean_[i].add(wave->states[i].result);
      rays_ += wave->states[i].result.rays;
      finish(i, wave->states[i]);
    }
  }

  void render_path() {
    for (int index = 0; index < job_.settings.spp; index += kTogether) {
      const int together = std::min(kTogether, job_.settings.spp - index);
      for (int first = 0; first < count_ * together; first += kLaneCount) {
        sample_lanes(first, index, together);
      }
    }
  }

  void render_direct() {
    const auto wave = std::make_unique<Wave<DirectState>>();
    for (int index = 0; index < job_.settings.spp; ++index) {
      sample(
          wave.get(), index, direct_start,
          [this](DirectState* state, bool found, const RayHit& hit) {
            return direct_advance(job_.scene, state, found, hit);
          },
          [this](int i, const DirectState& state) {
            known_[i] =
                job_.centered && (state.layers == 0 || (state.layers == 1 && state.has_first));
            center_found_[i] = state.has_first;
            center_hit_[i] = state.first;
          });
    }
  }

  /// Exact channels: centre rays in packets, except those that a centred sample has answered.
  void render_channels() {
    const auto wave = std::make_unique<Wave<CenterState>>();
    for (int i = 0; i < count_; ++i) {
      RayCone cone;
      wave->states[i].ray = center_ray(i, {}, 0, &cone);
      if (!known_[i]) wave->alive[wave->count++] = i;
    }
    const int traced = wave->count;
    std::copy(wave->alive, wave->alive + traced, trace_list_);
    wave->trace_closest(job_.tracer);
    rays_ += static_cast<uint64_t>(traced);
    for (int j = 0; j < traced; ++j) {
      center_found_[trace_list_[j]] = wave->found[trace_list_[j]];
      center_hit_[trace_list_[j]] = wave->hits[trace_list_[j]];
    }
    for (int i = 0; i < count_; ++i) store(i, wave->states[i].ray);
  }

  void store_means(RenderStats* stats) const {
    Film& film = *job_.film;
    for (int i = 0; i < count_; ++i) {
      const size_t pixel = pixel_of(i);
      film.radiance[pixel] = mean_[i].radiance;
      film.albedo[pixel] = mean_[i].albedo;
      film.normal[pixel] = mean_[i].normal;
      if (job_.settings.variance) film.variance[pixel] = mean_[i].variance();
    }
    stats->paths = static_cast<uint64_t>(count_) * static_cast<uint64_t>(job_.settings.spp);
    stats->rays = rays_;
  }

 private:
  /// Samples of a pixel that run side by side in lanes, at most: their rays keep together.
  static constexpr int kTogether = 4;

  /// Paths from the one on that is `first` when each pixel has `together` samples, the first of
  /// them `index`.
  void sample_lanes(int first, int index, int together) {
    using F = FloatLanes;
    const int used = std::min(kLaneCount, count_ * together - first);
    MaskLanes active = false;
    UintLanes x, y, sample;
    int pixel[kLaneCount];
    for (int i = 0; i < kLaneCount; ++i) {
      const int path = first + std::min(i, used - 1);
      pixel[i] = path / together;
      set_lane(&active, i, i < used);
      set_lane(&x, i, static_cast<uint32_t>(x_[pixel[i]]));
      set_lane(&y, i, static_cast<uint32_t>(y_[pixel[i]]));
      set_lane(&sample, i,
               static_cast<uint32_t>(job_.settings.first_sample + index + path % together));
    }
    const RenderSettings& settings = job_.settings;
    auto sampler =
        SamplerOf<F>::make(settings.seed, settings.frame, x, y, sample, job_.log2_samples);
    const Vec2Of<F> filter = sampler.next_2d();
    const F time = job_.has_motion ? sampler.next_1d() : F(0.0f);
    RayOf<F> ray;
    ray.time = time;
    F width, spread;
    for (int i = 0; i < kLaneCount; ++i) {
      RayCone cone;
      const Ray one =
          center_ray(pixel[i], sample_pixel_filter(lane(filter, i)), lane(time, i), &cone);
      set_lane(&ray.o, i, one.o);
      set_lane(&ray.d, i, one.d);
      set_lane(&width, i, cone.width);
      set_lane(&spread, i, cone.spread);
    }
    const PathResultOf<F> result =
        trace_path(job_.scene, job_.tracer, ray, width, spread, job_.path, sampler, active);
    for (int i = 0; i < used; ++i) {
      mean_[pixel[i]].add({lane(result.radiance, i), lane(result.albedo, i), lane(result.normal, i),
                           lane(result.rays, i)});
      rays_ += lane(result.rays, i);
    }
  }

  size_t pixel_of(int i) const { return static_cast<size_t>(y_[i]) * job_.film->width + x_[i]; }
  Ray center_ray(int i, Vec2f offset, float time, RayCone* cone) const {
    return camera_ray(job_.camera, static_cast<float>(x_[i]) + 0.5f + offset.x,
                      static_cast<float>(y_[i]) + 0.5f + offset.y, time, cone);
  }
  void store(int i, const Ray& ray) {
    RayCone cone;
    center_ray(i, {}, 0, &cone);
    if (!center_found_[i]) {
      store_channels(job_.film, pixel_of(i), describe_sky(job_.camera, ray));
      return;
    }
    Surface s = make_surface(job_.scene, ray, center_hit_[i], cone);
    if (!shows(job_.scene, s)) {
      uint32_t rays = 0;
      const bool found = find_first(job_.scene, job_.tracer, ray, cone, &s, &center_hit_[i], &rays);
      rays_ += rays;
      if (!found) {
        store_channels(job_.film, pixel_of(i), describe_sky(job_.camera, ray));
        return;
      }
    }
    store_channels(job_.film, pixel_of(i),
                   describe_surface(job_.scene, job_.camera, ray, s, center_hit_[i]));
  }

  const Job& job_;
  int count_ = 0;
  uint64_t rays_ = 0;
  int x_[kTile * kTile], y_[kTile * kTile], trace_list_[kTile * kTile];
  PixelMean mean_[kTile * kTile];
  bool known_[kTile * kTile] = {}, center_found_[kTile * kTile] = {};
  RayHit center_hit_[kTile * kTile];
};

}  // namespace gloam

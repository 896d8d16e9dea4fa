#include "render/cpu/fast_tier.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/cpu/fast_edges.h"
#include "render/cpu/tile.h"
#include "render/kernel/fast.h"

namespace gloam {
namespace {

constexpr float kCellPixels = 32;     // edge of a cache's cell in the picture,
constexpr float kWidestCell = 0.05f;  // or over its distance if that is less
constexpr int kWarmUp = 10;           // updates of the cache before the first picture

/// Requests of one tile, each cell's first.
struct TileRequests {
  static constexpr size_t kSlots = 1024;
  std::vector<CacheRequest> list;
  uint64_t seen[kSlots] = {};

  void add(const CacheRequest& request) {
    if (request.key == 0) return;
    uint64_t& slot = seen[caches::slot_of(request.key, kSlots)];
    if (slot == request.key) return;
    slot = request.key;
    list.push_back(request);
  }
};

}  // namespace

void FastHistory::trace(const SceneView& scene, const EmbreeTracer& tracer,
                        const CameraView32& camera, const RenderSettings& settings, Film* film) {
  using F = FloatLanes;
  const float edge = min(kCellPixels / camera.fx, kWidestCell);
  const IrradianceCacheView cache = cache_.view(camera.pose.X_WC_open.p, edge);
  const int columns = (film->width + kTile - 1) / kTile, rows = (film->height + kTile - 1) / kTile;
  std::vector<TileRequests> asked(static_cast<size_t>(columns) * rows);
  std::vector<uint64_t> rays(asked.size());
  parallel_for("fast tiles", static_cast<int64_t>(asked.size()), [&](int64_t tile) {
    const FlushDenormals flush;
    const int x0 = static_cast<int>(tile % columns) * kTile;
    const int y0 = static_cast<int>(tile / columns) * kTile;
    for (int first = 0; first < kTile * kTile; first += kLaneCount) {
      MaskLanes active = false;
      UintLanes px, py;
      RayOf<F> ray;
      F width, spread;
      int xs[kLaneCount], ys[kLaneCount];
      for (int i = 0; i < kLaneCount; ++i) {
        tile_pixel(first + i, &xs[i], &ys[i]);
        xs[i] += x0;
        ys[i] += y0;
        const bool inside = xs[i] < film->width && ys[i] < film->height;
        RayCone cone;
        const Ray one = camera_ray(camera, static_cast<float>(xs[i]) + 0.5f,
                                   static_cast<float>(ys[i]) + 0.5f, 0, &cone);
        set_lane(&active, i, inside && sees(one));
        set_lane(&px, i, static_cast<uint32_t>(xs[i]));
        set_lane(&py, i, static_cast<uint32_t>(ys[i]));
        set_lane(&ray.o, i, one.o);
        set_lane(&ray.d, i, one.d);
        set_lane(&width, i, cone.width);
        set_lane(&spread, i, cone.spread);
      }
      CacheRequest requests[3 * kLaneCount];
      const FastSampleOf<F> sample = trace_fast(
          scene, tracer, cache, ray, width, spread,
          SamplerOf<F>::make(settings.seed, settings.frame, px, py, 0u, 0), active, requests);
      for (int i = 0; i < kLaneCount; ++i) {
        if (xs[i] >= film->width || ys[i] >= film->height) continue;
        asked[static_cast<size_t>(tile)].add(requests[i]);
        asked[static_cast<size_t>(tile)].add(requests[kLaneCount + i]);
        asked[static_cast<size_t>(tile)].add(requests[2 * kLaneCount + i]);
        const int x = xs[i], y = ys[i];
        const size_t pixel = static_cast<size_t>(y) * film->width + x;
        const bool solid = lane(sample.solid, i);
        const Surface surface = lane(sample.surface, i);
        const Vec3f through = lane(sample.through, i);
        now_.base.set(x, y, lane(sample.base, i));
        now_.albedo.set(x, y, solid ? lane(sample.albedo, i) * through : Vec3f{});
        now_.gloss.set(x, y, solid ? lane(sample.gloss, i) * through : Vec3f{});
        now_.signal[kDirectSignal].set(x, y, lane(sample.direct, i));
        now_.signal[kSpecularSignal].set(x, y, lane(sample.specular, i) * through);
        now_.p.set(x, y, surface.p);
        now_.n.set(x, y, surface.normal);
        *now_.part.at(x, y) = solid ? static_cast<float>(surface.instance + 1) : 0.0f;
        *now_.distance.at(x, y) = lane(sample.hit.t, i);
        *now_.roughness.at(x, y) = surface.roughness;
        now_.key[pixel] = solid ? requests[i].key : 0;
        film->albedo[pixel] = solid ? surface.base_color : Vec3f{};
        film->normal[pixel] = solid ? surface.normal : Vec3f{};
        const Ray one = lane(ray, i);
        const ExactChannels channels =
            solid             ? describe_surface(scene, camera, one, surface, lane(sample.hit, i))
            : lane(active, i) ? describe_sky(camera, one)
                              : ExactChannels();
        now_.motion[pixel] = channels.motion;
        if (settings.exact_channels) store_channels(film, pixel, channels);
        rays[static_cast<size_t>(tile)] += lane(sample.rays, i);
      }
    }
  });
  requests_.clear();
  for (const TileRequests& t : asked)
    requests_.insert(requests_.end(), t.list.begin(), t.list.end());
  for (const uint64_t r : rays) rays_ += r;
}

void FastHistory::compose(Film* film) const {
  parallel_for("fast picture", film->height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < film->width; ++x) {
      const Vec3f direct = filter_.a[kDirectSignal].get(x, y);
      const Vec3f cached = filter_.a[kCachedSignal].get(x, y);
      const Vec3f specular = filter_.a[kSpecularSignal].get(x, y);
      film->radiance[static_cast<size_t>(y) * film->width + x] =
          now_.base.get(x, y) + now_.albedo.get(x, y) * (direct + cached) +
          now_.gloss.get(x, y) * cached + specular;
    }
  });
}

RenderStats FastHistory::render(const SceneView& scene, const EmbreeTracer& tracer,
                                const CameraView32& camera, const RenderSettings& settings,
                                Film* film) {
  rays_ = 0;
  if (film->width != now_.width || film->height != now_.height) {
    now_.resize(film->width, film->height);
    filter_.resize(film->width, film->height);
  }
  const Vec3f eye = camera.pose.X_WC_open.p;
  const float edge = min(kCellPixels / camera.fx, kWidestCell);
  for (bool again = true; again; warm_ = true) {
    again = !warm_;  // a first picture is traced twice: its specular rays saw no cache
    trace(scene, tracer, camera, settings, film);
    cache_.ask(requests_);
    rays_ +=
        cache_.update(scene, tracer, eye, edge, settings.seed, settings.frame, warm_ ? 1 : kWarmUp);
  }
  const IrradianceCacheView cache = cache_.view(eye, edge);
  parallel_for("fast light", film->height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < film->width; ++x) {
      const int cell = find_cell(cache, now_.key[static_cast<size_t>(y) * film->width + x]);
      now_.signal[kCachedSignal].set(
          x, y, cell >= 0 ? cache.light[static_cast<uint32_t>(cell)] : Vec3f{});
    }
  });
  filter_.accumulate(before_, &now_);
  filter_.smooth(now_);
  compose(film);
  rays_ += smooth_edges(scene, tracer, camera, now_, film);
  std::swap(now_, before_);
  RenderStats stats;
  stats.paths = film->pixel_count();
  stats.rays = rays_;
  return stats;
}

}  // namespace gloam

#include "render/cpu/fast_tier.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "render/cpu/tile.h"
#include "render/kernel/fast.h"

namespace gloam {
namespace {

using F = FloatLanes;

constexpr float kCellPixels = 32;       // edge of a cache's cell in the picture,
constexpr float kWidestCell = 0.05f;    // or over its distance if that is less
constexpr int kWarmUp = 12;             // updates of the cache before the first picture
constexpr uint32_t kFirstPictures = 8;  // of the first instant, one upon the other
constexpr uint32_t kPattern = 16;       // points of a pixel that pictures go through in turn

float cell_edge(const CameraView32& camera) { return min(kCellPixels / camera.fx, kWidestCell); }

/// Requests of one tile: of each cell, one place by chance.
class TileRequests {
 public:
  explicit TileRequests(std::vector<CacheRequest>* list) : list_(*list) { list_.clear(); }

  static constexpr uint32_t kDice = 1u << 24;
  /// `dice`: below kDice.
  void add(const CacheRequest& request, uint32_t dice) {
    if (request.key == 0) return;
    Slot& slot = slots_[caches::slot_of(request.key, kSlots)];
    if (slot.key != request.key) {
      slot = {request.key, static_cast<uint32_t>(list_.size()), 0};
      list_.push_back(request);
    }
    if (uint64_t{dice} * ++slot.count < kDice) list_[slot.row] = request;
  }

 private:
  static constexpr size_t kSlots = 256;
  struct Slot {
    uint64_t key = 0;
    uint32_t row = 0, count = 0;
  };
  std::vector<CacheRequest>& list_;
  Slot slots_[kSlots];
};

/// Four by four pixels, or half of them, and the rays through them.
struct PixelBlock {
  int x = 0, y = 0;
  MaskLanes inside = false;  ///< of the picture
  MaskLanes active = false;  ///< and the lens sees something there
  UintLanes px, py;
  RayOf<F> ray;
  RayConeOf<F> cone;
};

PixelBlock make_block(const CameraView32& camera, const FastFrame& frame, int x, int y) {
  PixelBlock block;
  block.x = x;
  block.y = y;
  F u, v;
  for (int i = 0; i < kLaneCount; ++i) {
    const int column = x + i % 4, row = y + i / 4;
    set_lane(&block.inside, i, column < frame.width && row < frame.height);
    set_lane(&block.px, i, static_cast<uint32_t>(column));
    set_lane(&block.py, i, static_cast<uint32_t>(row));
    set_lane(&u, i, static_cast<float>(column) + 0.5f + frame.offset.x);
    set_lane(&v, i, static_cast<float>(row) + 0.5f + frame.offset.y);
  }
  block.ray = camera_rays(camera, u, v, F(0.0f), &block.cone);
  block.active = block.inside & (block.ray.tmax > 0.0f);
  return block;
}

/// Way of what is seen since the previous picture [px].
Vec2Of<F> motion_of(const SceneView& scene, const CameraView32& camera, const PixelBlock& block,
                    const FastSampleOf<F>& sample) {
  const MaskLanes solid = block.active & sample.solid;
  const Vec3Of<F> before = previous_points(scene, sample.p, sample.hit, block.ray.time, solid);
  return find_motion(camera, block.ray, sample.p, before, solid, block.active);
}

/// Pixels take turns from picture to picture.
FastTurnsOf<F> turns_of(const PixelBlock& block, uint32_t picture) {
  constexpr uint32_t kOrder[4] = {0, 3, 1, 2};
  const UintLanes place = (block.px & 1u) + (block.py & 1u) * 2u;
  return {((block.px + block.py + picture) & 1u) == 0u, place == kOrder[picture % 4]};
}

/// Points of [0, 1)² for the pixels from `first` on of four by four, each in a part of its own.
Vec2Of<F> stratified(int first, Vec2f turn) {
  constexpr int kOrder[16] = {0, 10, 5, 15, 12, 6, 9, 3, 8, 2, 13, 7, 4, 14, 1, 11};
  Vec2Of<F> u;
  for (int i = 0; i < kLaneCount; ++i) {
    const int k = kOrder[(first + i) % 16], column = k % 4, row = k / 4;
    set_lane(&u, i,
             {(static_cast<float>(column) + turn.x) / 4, (static_cast<float>(row) + turn.y) / 4});
  }
  return u;
}

void store(const PixelBlock& block, const FastSampleOf<F>& sample, Vec2Of<F> motion,
           const CacheRequest* requests, FastFrame* frame) {
  const int x = block.x, y = block.y;
  const auto solid = [&](const Vec3Of<F>& v) { return select<F>(sample.solid, v, Vec3Of<F>{}); };
  frame->base.store_block(x, y, sample.base);
  frame->albedo.store_block(x, y, solid(sample.albedo * sample.through));
  frame->gloss.store_block(x, y, solid(sample.gloss * sample.through));
  frame->signal[kDirectSignal].store_block(x, y, sample.direct);
  frame->signal[kSpecularSignal].store_block(x, y, sample.specular * sample.through);
  frame->p.store_block(x, y, sample.p);
  frame->n.store_block(x, y, sample.normal);
  const F part = select(sample.solid, to_float(sample.hit.instance) + 1.0f, F(0.0f));
  frame->part.store_block(x, y, select(block.inside, part, F(-1.0f)));
  frame->distance.store_block(x, y, select(sample.solid, sample.hit.t, F(1e20f)));
  frame->roughness.store_block(x, y, sample.roughness);
  frame->near.store_block(x, y, sample.near);
  frame->motion_x.store_block(x, y, motion.x);
  frame->motion_y.store_block(x, y, motion.y);
  each_lane(block.inside, [&](int i) {
    const size_t pixel = static_cast<size_t>(y + i / 4) * frame->width + x + i % 4;
    frame->key[pixel] = lane(sample.solid, i) ? requests[i].key : 0;
  });
}

}  // namespace

void FastHistory::trace(const SceneView& scene, const CpuTracer& tracer, const CameraView32& camera,
                        const RenderSettings& settings, uint32_t pass) {
  const IrradianceCacheView cache = cache_.view(camera.pose.X_WC_open.p, cell_edge(camera));
  Sampler pattern = Sampler::make(0, 0, 0, 0, pictures_ % kPattern, 3);
  now_.offset = pattern.next_2d() - Vec2f{0.5f, 0.5f};
  const int columns = (now_.width + kTile - 1) / kTile, rows = (now_.height + kTile - 1) / kTile;
  const Vec2f turn = pattern.next_2d();
  asked_.resize(static_cast<size_t>(columns) * rows);
  std::vector<uint64_t> rays(asked_.size());
  parallel_for("fast tiles", static_cast<int64_t>(asked_.size()), [&](int64_t tile) {
    const FlushDenormals flush;
    TileRequests mine(&asked_[static_cast<size_t>(tile)]);
    for (int first = 0; first < kTile * kTile; first += kLaneCount) {
      int x, y;
      tile_pixel(first, &x, &y);
      x += static_cast<int>(tile % columns) * kTile;
      y += static_cast<int>(tile / columns) * kTile;
      if (x >= now_.width || y >= now_.height) continue;
      const PixelBlock block = make_block(camera, now_, x, y);
      const auto sampler = SamplerOf<F>::of_turn(settings.seed, block.px, block.py, pictures_);
      const Vec2Of<F> near_u = stratified(first, turn);
      CacheRequest requests[3 * kLaneCount];
      const FastSampleOf<F> sample =
          trace_fast(scene, tracer, cache, block.ray, block.cone.width, block.cone.spread, sampler,
                     near_u, turns_of(block, pictures_), block.active, requests);
      // Pictures of one instant have no way between them.
      const Vec2Of<F> motion = pass == 0 ? motion_of(scene, camera, block, sample) : Vec2Of<F>{};
      store(block, sample, motion, requests, &now_);
      const uint32_t dice = static_cast<uint32_t>(first) * 0x9E3779B9u + pictures_ * 0x85EBCA6Bu;
      for (uint32_t i = 0; i < 3 * kLaneCount; ++i) {
        mine.add(requests[i], (dice + i * 0xC2B2AE35u) >> 8);
      }
      each_lane(block.active,
                [&](int i) { rays[static_cast<size_t>(tile)] += lane(sample.rays, i); });
    }
  });
  requests_.clear();
  for (const std::vector<CacheRequest>& list : asked_)
    requests_.insert(requests_.end(), list.begin(), list.end());
  for (const uint64_t r : rays) rays_ += r;
}

void FastHistory::look_up(const IrradianceCacheView& cache) {
  parallel_for("fast light", now_.height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < now_.width; ++x) {
      const int cell = find_cell(cache, now_.key[static_cast<size_t>(y) * now_.width + x]);
      now_.signal[kCachedSignal].set(
          x, y,
          cell >= 0 ? light_at(cache.light[static_cast<uint32_t>(cell)], *now_.near.at(x, y))
                    : Vec3f{});
    }
  });
}

void FastHistory::compose() {
  parallel_for("fast picture", now_.height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < now_.width; x += kLaneCount) {
      const Vec3Of<F> cached = filter_.smoothed(kCachedSignal).load(x, y);
      const Vec3Of<F> diffuse = filter_.smoothed(kDirectSignal).load(x, y) + cached;
      const Vec3Of<F> specular = filter_.smoothed(kSpecularSignal).load(x, y);
      const Vec3Of<F> color = now_.base.load(x, y) + now_.albedo.load(x, y) * diffuse +
                              now_.gloss.load(x, y) * cached + specular;
      now_.color.store(x, y, color);
      const MaskLanes moves =
          !((now_.motion_x.load(x, y) == F(0.0f)) & (now_.motion_y.load(x, y) == F(0.0f)));
      const F gleam = 0.5f * luminance(specular) / max(luminance(color), F(1e-6f));
      now_.gleam.store(x, y, select(moves & (now_.roughness.load(x, y) < kMirror), gleam, F(0.0f)));
    }
  });
}

void FastHistory::add_picture(const SceneView& scene, const CpuTracer& tracer,
                              const CameraView32& camera, const RenderSettings& settings,
                              uint32_t pass) {
  const Vec3f eye = camera.pose.X_WC_open.p;
  const float edge = cell_edge(camera);
  for (bool again = true; again;) {
    again = cache_.size() == 0;  // a first picture is traced twice: its rays saw no cache
    trace(scene, tracer, camera, settings, pass);
    cache_.ask(requests_);
    rays_ += cache_.update(scene, tracer, eye, edge, settings.seed, again ? kWarmUp : 1);
    if (requests_.empty()) break;
  }
  look_up(cache_.view(eye, edge));
  filter_.accumulate(before_, &now_);
  filter_.smooth(now_);
  compose();
  resolve(before_, &filter_.color_gain, &now_);
  std::swap(now_, before_);
  ++pictures_;
}

RenderStats FastHistory::render(const SceneView& scene, const CpuTracer& tracer,
                                const CameraView32& camera, const RenderSettings& settings,
                                Film* film) {
  rays_ = 0;
  if (film->width != now_.width || film->height != now_.height) {
    now_.resize(film->width, film->height);
    before_.resize(film->width, film->height);
    filter_.resize(film->width, film->height);
    pictures_ = 0;
  }
  const uint32_t passes = pictures_ == 0 ? kFirstPictures : 1;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    add_picture(scene, tracer, camera, settings, pass);
  }
  parallel_for("fast film", film->height, [&](int64_t y) {
    for (int x = 0; x < film->width; ++x) {
      film->radiance[static_cast<size_t>(y) * film->width + x] =
          before_.resolved.get(x, static_cast<int>(y));
    }
  });
  RenderStats stats;
  stats.paths = film->pixel_count();
  stats.rays = rays_;
  return stats;
}

}  // namespace gloam

// One picture of the interactive tier before it is filtered: camera rays block by block, and their
// reflections by the tile.

#include <cstdlib>

#include "base/parallel.h"
#include "render/cpu/interactive/gather_lanes.h"
#include "render/cpu/interactive/interactive_tier.h"
#include "render/cpu/path/tile.h"
#include "render/kernel/interactive/camera_sample.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Requests of one tile: of each cell, one place by chance.
class TileRequests {
 public:
  explicit TileRequests(std::vector<CacheRequest>* list) : list_(*list) { list_.clear(); }

  static constexpr uint32_t kRandomEnd = 1u << 24;
  /// Adds a request; `random`: below kRandomEnd.
  void add(const CacheRequest& request, uint32_t random) {
    if (request.key == 0) return;
    Slot& slot = slots_[caches::slot_of(request.key, kSlots)];
    if (slot.key != request.key) {
      slot = {request.key, static_cast<uint32_t>(list_.size()), 0};
      list_.push_back(request);
    }
    if (uint64_t{random} * ++slot.count < kRandomEnd) list_[slot.row] = request;
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

/// Random number below TileRequests::kRandomEnd, for one of the requests of a pixel in a picture.
uint32_t random_of(int x, int y, int kind, uint32_t picture) {
  const auto place = static_cast<uint32_t>(y) << 16 | static_cast<uint32_t>(x);
  return mix_bits(place ^ (picture * 8u + static_cast<uint32_t>(kind)) * 0x9E3779B9u) >> 8;
}

/// Four by four pixels, or half of them, and the rays through them.
struct PixelBlock {
  int x = 0, y = 0;
  MaskLanes inside = false;  ///< of the picture
  MaskLanes active = false;  ///< and the lens sees something there
  UintLanes px, py;
  RayOf<F> ray;
  RayConeOf<F> cone;
};

PixelBlock make_block(const CameraView32& camera, const InteractiveFrame& frame, int x, int y) {
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
  // Frames add up to the image's resolution: textures are filtered for its pixels.
  block.cone.width *= interactive::kFrameScale;
  block.cone.spread *= interactive::kFrameScale;
  block.active = block.inside & (block.ray.tmax > 0.0f);
  return block;
}

/// Motion of the surfaces in view since the previous picture [px].
Vec2Of<F> motion_of(const SceneView& scene, const CameraView32& camera, const PixelBlock& block,
                    const InteractiveSampleOf<F>& sample) {
  const MaskLanes solid = block.active & sample.solid;
  const Vec3Of<F> before = previous_points(scene, sample.p, sample.hit, block.ray.time, solid);
  return find_motion(camera, block.ray, sample.p, before, solid, block.active);
}

/// Leaders of quads, other pixels from picture to picture.
QuadLeadersOf<F> leaders_of(const PixelBlock& block, uint32_t picture) {
  constexpr uint32_t kOrder[4] = {0, 3, 1, 2};
  const UintLanes place = (block.px & 1u) + (block.py & 1u) * 2u;
  return {((block.px + block.py + picture) & 1u) == 0u, place == kOrder[picture % 4]};
}

/// Points of [0, 1)² for the pixels from `first` on of four by four, each in a part of its own.
Vec2Of<F> stratified(int first, Vec2f offset) {
  constexpr int kOrder[16] = {0, 10, 5, 15, 12, 6, 9, 3, 8, 2, 13, 7, 4, 14, 1, 11};
  Vec2Of<F> u;
  for (int i = 0; i < kLaneCount; ++i) {
    const int k = kOrder[(first + i) % 16], column = k % 4, row = k / 4;
    set_lane(
        &u, i,
        {(static_cast<float>(column) + offset.x) / 4, (static_cast<float>(row) + offset.y) / 4});
  }
  return u;
}

void store(const PixelBlock& block, const InteractiveSampleOf<F>& sample, Vec2Of<F> motion,
           const CacheRequest* requests, InteractiveFrame* frame) {
  const int x = block.x, y = block.y;
  const auto solid = [&](const Vec3Of<F>& v) { return select<F>(sample.solid, v, Vec3Of<F>{}); };
  frame->base.store_block(x, y, sample.base);
  frame->albedo.store_block(x, y, solid(sample.albedo * sample.through));
  frame->gloss.store_block(x, y, solid(sample.gloss * sample.through));
  frame->signal[kDirectSignal].store_block(x, y, sample.direct);
  frame->signal[kAirSignal].store_block(x, y, sample.air);
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

/// Spreads the excess of single pixels over all light that a tile's media scatter: filters preserve
/// outliers, and the light of lamps nearby comes to few pixels.
void spread_air(int x0, int y0, InteractiveFrame* frame) {
  InteractivePlane3& air = frame->signal[kAirSignal];
  const int x1 = std::min(x0 + kTile, frame->width), y1 = std::min(y0 + kTile, frame->height);
  const auto each = [&](const auto& visit) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) visit(x, y, air.get(x, y));
    }
  };
  float all = 0, kept = 0;
  each([&](int, int, Vec3f v) { all += luminance(v); });
  const float most = interactive::kBrightestAir * all / static_cast<float>((x1 - x0) * (y1 - y0));
  each([&](int, int, Vec3f v) { kept += min(luminance(v), most); });
  if (!(kept < all)) return;
  const float gain = all / kept;
  each([&](int x, int y, Vec3f v) {
    air.set(x, y, v * (gain * min(most / max(luminance(v), 1e-9f), 1.0f)));
  });
}

/// Reflections that one block's pixels wait for.
struct PendingBlock {
  int x = 0, y = 0;
  ReflectionUseOf<F> use;
  Vec3Of<F> specular, through;  ///< of InteractiveSampleOf
  Vec3Of<F> seen;               ///< along the reflection
};

/// Rays of reflections from all over a tile side by side, as few lanes of a block have one of their
/// own.
class ReflectedRays {
 public:
  ReflectedRays(const InteractiveWorld<CpuTracer>& world, uint32_t picture, TileRequests* requests)
      : world_(world), picture_(picture), requests_(*requests) {}

  void add(const ReflectionOf<F>& reflection, PendingBlock* block) {
    each_lane(reflection.use.goes, [&](int i) {
      copy_lane(reflection.reflected, i, &rays_, count_);
      of_[count_++] = {block, i};
      if (count_ == kLaneCount) trace();
    });
  }
  /// Traces the reflections that are left; returns the number of all rays.
  uint64_t finish() {
    if (count_ > 0) trace();
    return traced_;
  }

 private:
  void trace() {
    MaskLanes active = false;
    for (int k = 0; k < count_; ++k) set_lane(&active, k, true);
    CacheRequest asked[kLaneCount];
    UintLanes traced = 0u;
    const Vec3Of<F> seen = trace_reflection(world_, rays_, active, &traced, asked);
    for (int k = 0; k < count_; ++k) {
      const auto [block, i] = of_[k];
      set_lane(&block->seen, i, lane(seen, k));
      requests_.add(asked[k], random_of(block->x + i % 4, block->y + i / 4, kRequests, picture_));
      traced_ += lane(traced, k);
    }
    count_ = 0;
  }

  struct Place {
    PendingBlock* block;
    int lane;
  };
  const InteractiveWorld<CpuTracer>& world_;
  const uint32_t picture_;
  TileRequests& requests_;
  ReflectedRayOf<F> rays_;
  Place of_[kLaneCount];
  int count_ = 0;
  uint64_t traced_ = 0;
};

}  // namespace

uint64_t InteractiveHistory::trace_tile(const InteractiveView& view, uint32_t pass, int x0, int y0,
                                        AskedOfTile* asked) {
  const FlushDenormals flush;
  InteractiveWorld<CpuTracer> world{view.scene, view.tracer, view.cache};
  if (view.lamps) world.lamps = &*view.lamps, world.movers = &view.movers;
  TileRequests seen(&asked->seen), mirrored(&asked->mirrored), lamps(&asked->lamps);
  ReflectedRays reflected(world, pictures_, &mirrored);
  PendingBlock blocks[kTile * kTile / kLaneCount];
  int count = 0;
  uint64_t rays = 0;
  for (int first = 0; first < kTile * kTile; first += kLaneCount) {
    int x, y;
    tile_pixel(first, &x, &y);
    if (x0 + x >= now_.width || y0 + y >= now_.height) continue;
    const PixelBlock pixels = make_block(view.camera, now_, x0 + x, y0 + y);
    CacheRequest requests[kRequests * kLaneCount];
    const InteractivePixelsOf<F> rays_in{
        pixels.ray,
        pixels.cone,
        SamplerOf<F>::of_turn(view.seed, pixels.px, pixels.py, pictures_),
        stratified(first, near_offset_),
        leaders_of(pixels, pictures_),
        pixels.active};
    const InteractiveSampleOf<F> sample = trace_camera_rays(world, rays_in, requests);
    // Pictures of one instant have no way between them.
    const Vec2Of<F> motion =
        pass == 0 ? motion_of(view.scene, view.camera, pixels, sample) : Vec2Of<F>{};
    store(pixels, sample, motion, requests, &now_);
    // Pixel by pixel, so that it is the same for any number of lanes.
    for (int i = 0; i < kLaneCount; ++i) {
      for (int kind = 0; kind < kRequests; ++kind) {
        TileRequests& list = kind == kLampRequest ? lamps : seen;
        list.add(requests[kind * kLaneCount + i],
                 random_of(pixels.x + i % 4, pixels.y + i / 4, kind, pictures_));
      }
    }
    PendingBlock& block = blocks[count++];
    block = {pixels.x, pixels.y, sample.reflection.use, sample.specular, sample.through, {}};
    reflected.add(sample.reflection, &block);
    each_lane(pixels.active, [&](int i) { rays += lane(sample.rays, i); });
  }
  if (view.cache.lamps_move && now_.signals > kAirSignal) spread_air(x0, y0, &now_);
  rays += reflected.finish();
  for (int b = 0; b < count; ++b) {
    const PendingBlock& block = blocks[b];
    now_.signal[kSpecularSignal].store_block(
        block.x, block.y,
        (block.specular + reflected_light(block.use, block.seen)) * block.through);
  }
  return rays;
}

void InteractiveHistory::trace(const InteractiveView& view, uint32_t pass, RenderSlices* slices) {
  Sampler pattern = Sampler::make(0, 0, 0, 0, pictures_ % interactive::kPixelPoints, 3);
  now_.offset = pattern.next_2d() - Vec2f{0.5f, 0.5f};
  near_offset_ = pattern.next_2d();
  const int columns = (now_.width + kTile - 1) / kTile, rows = (now_.height + kTile - 1) / kTile;
  asked_.resize(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  std::vector<uint64_t> traced(asked_.size());
  slices->run("interactive tiles", static_cast<int64_t>(asked_.size()), [&](int64_t tile) {
    const auto [row, column] = std::div(tile, int64_t{columns});
    SceneView plain = view.scene;  // rays of pixels go where they must
    plain.guide.probability = 0;
    traced[static_cast<size_t>(tile)] = trace_tile(
        {plain, view.tracer, view.movers, view.camera, view.cache, view.lamps, view.seed}, pass,
        static_cast<int>(column) * kTile, static_cast<int>(row) * kTile,
        &asked_[static_cast<size_t>(tile)]);
  });
  requests_.clear();
  lamp_requests_.clear();
  for (const AskedOfTile& of : asked_) {
    lamp_requests_.insert(lamp_requests_.end(), of.lamps.begin(), of.lamps.end());
    requests_.insert(requests_.end(), of.seen.begin(), of.seen.end());
    requests_.insert(requests_.end(), of.mirrored.begin(), of.mirrored.end());
  }
  for (const uint64_t r : traced) rays_ += r;
}

}  // namespace gloam

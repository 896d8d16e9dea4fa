#include "render/cpu/irradiance_cache.h"

#include <algorithm>

#include "base/parallel.h"

namespace gloam {
namespace {

constexpr int kRays = 32;            // of a cell and update
constexpr int kMemory = 5 * kRays;   // rays that a cell's mean is of, at most
constexpr uint32_t kForgotten = 30;  // updates after which a cell that nobody asks for goes
constexpr size_t kMostCells = 2500;  // of an update, but for a first picture's
constexpr float kSurprise = 2.5f;    // standard errors
constexpr float kSpread = 0.15f;     // of the rays' cones: no fine texture is sought

}  // namespace

uint32_t IrradianceCache::slot_of(uint64_t key) const {
  const auto size = static_cast<uint32_t>(keys_.size());
  uint32_t slot = caches::slot_of(key, size);
  while (keys_[slot] != 0 && keys_[slot] != key) slot = (slot + 1) & (size - 1);
  return slot;
}

void IrradianceCache::rebuild(size_t slots) {
  keys_.assign(slots, 0);
  rows_.assign(slots, 0);
  for (size_t row = 0; row < cells_.size(); ++row) {
    const uint32_t slot = slot_of(cells_[row].key);
    keys_[slot] = cells_[row].key;
    rows_[slot] = static_cast<uint32_t>(row);
  }
}

void IrradianceCache::ask(const std::vector<CacheRequest>& requests) {
  if (keys_.empty()) rebuild(1u << 12);
  for (const CacheRequest& request : requests) {
    if (request.key == 0) continue;
    uint32_t slot = slot_of(request.key);
    if (keys_[slot] == 0) {
      if (2 * (cells_.size() + 1) > keys_.size()) {
        rebuild(2 * keys_.size());
        slot = slot_of(request.key);
      }
      keys_[slot] = request.key;
      rows_[slot] = static_cast<uint32_t>(cells_.size());
      cells_.push_back({request.key});
      light_.emplace_back();
      starts_.resize(cells_.size() * kStarts);
    }
    const uint32_t row = rows_[slot];
    Cell& cell = cells_[row];
    cell.last_asked = update_;
    if (cell.starts < kStarts)
      starts_[row * kStarts + static_cast<size_t>(cell.starts++)] = request;
  }
}

uint64_t IrradianceCache::trace(const SceneView& scene, const EmbreeTracer& tracer,
                                const IrradianceCacheView& cache, uint64_t seed, uint32_t frame,
                                bool remembers) {
  using F = FloatLanes;
  std::vector<uint64_t> rays(asked_.size());
  next_ = light_;
  further_.assign(asked_.size() * kFurther, {});
  parallel_for_range(
      "irradiance cache", static_cast<int64_t>(asked_.size()), 4, [&](int64_t begin, int64_t end) {
        for (int64_t k = begin; k < end; ++k) {
          const uint32_t row = asked_[static_cast<size_t>(k)];
          const Cell& cell = cells_[row];
          Vec3f sum;
          float squares = 0;
          for (int first = 0; first < kRays; first += kLaneCount) {
            paths::State<F> path;
            UintLanes index;
            for (int i = 0; i < kLaneCount; ++i)
              set_lane(&index, i, static_cast<uint32_t>(first + i));
            const uint64_t mixed = cell.key * 0x9E3779B97F4A7C15ull;
            path.sampler =
                SamplerOf<F>::make(seed ^ mixed, frame, UintLanes(0u), UintLanes(0u), index, 6);
            path.throughput = in_all_lanes<F>({1, 1, 1});
            const Vec3Of<F> local = sample_cosine_hemisphere(path.sampler.next_2d());
            for (int i = 0; i < kLaneCount; ++i) {
              const CacheRequest& start =
                  starts_[row * kStarts + static_cast<size_t>((first + i) % cell.starts)];
              set_lane(&path.ray.o, i, start.p);
              set_lane(&path.ray.d, i, Frame::from_z(start.n).to_world(lane(local, i)));
            }
            path.cone_spread = kSpread;
            path.from = path.ray.o;
            CacheRequest met[kLaneCount];
            const Vec3Of<F> light =
                fasts::gather(scene, tracer, cache, false, MaskLanes(true), &path, met);
            for (int i = 0; i < kLaneCount; ++i) {
              sum += lane(light, i);
              squares += sqr(luminance(lane(light, i)));
              rays[static_cast<size_t>(k)] += lane(path.result.rays, i);
            }
            if (first == 0)
              std::copy_n(met, kFurther, &further_[static_cast<size_t>(k) * kFurther]);
          }
          const Vec3f mean = sum / static_cast<float>(kRays);
          float share = static_cast<float>(kRays) /
                        static_cast<float>(std::min(cell.samples, kMemory) + kRays);
          // What noise does not explain is a change of the light.
          const float l = luminance(mean), before = luminance(light_[row]);
          const float error = safe_sqrt((squares / kRays - l * l) / kRays);
          if (fabsf(l - before) > kSurprise * error + 0.02f * before) share = max(share, 0.75f);
          if (!remembers) share = 1;  // too little of the light had come round before
          next_[row] = lerp(light_[row], mean, share);
        }
      });
  std::swap(light_, next_);
  for (const uint32_t row : asked_) {
    cells_[row].samples = remembers ? cells_[row].samples + kRays : kRays;
    cells_[row].last_traced = update_;
  }
  uint64_t total = 0;
  for (const uint64_t r : rays) total += r;
  return total;
}

uint64_t IrradianceCache::update(const SceneView& scene, const EmbreeTracer& tracer, Vec3f eye,
                                 float edge_per_metre, uint64_t seed, uint32_t frame, int settle) {
  uint64_t rays = 0;
  for (int i = 0; i < settle; ++i) {
    ask(std::vector<CacheRequest>(std::move(further_)));
    asked_.clear();
    for (uint32_t row = 0; row < cells_.size(); ++row) {
      if (cells_[row].starts > 0) asked_.push_back(row);
    }
    // Those that have waited longest, new ones before all; of these in the order of their making.
    const auto waits = [this](uint32_t row) {
      return cells_[row].samples == 0 ? update_ + 1 : update_ - cells_[row].last_traced;
    };
    std::stable_sort(asked_.begin(), asked_.end(),
                     [&](uint32_t a, uint32_t b) { return waits(a) > waits(b); });
    if (settle == 1 && asked_.size() > kMostCells) asked_.resize(kMostCells);
    rays += trace(scene, tracer, view(eye, edge_per_metre), seed + static_cast<uint64_t>(i), frame,
                  settle == 1);
  }
  forget();
  return rays;
}

void IrradianceCache::forget() {
  ++update_;
  size_t kept = 0;
  for (size_t row = 0; row < cells_.size(); ++row) {
    cells_[row].starts = 0;
    if (cells_[row].last_asked + kForgotten < update_) continue;
    cells_[kept] = cells_[row];
    light_[kept] = light_[row];
    ++kept;
  }
  if (kept == cells_.size()) return;
  cells_.resize(kept);
  light_.resize(kept);
  starts_.resize(kept * kStarts);
  rebuild(keys_.size());
}

IrradianceCacheView IrradianceCache::view(Vec3f eye, float edge_per_metre) const {
  IrradianceCacheView view;
  view.keys = {keys_.data(), static_cast<uint32_t>(keys_.size())};
  view.cells = {rows_.data(), static_cast<uint32_t>(rows_.size())};
  view.light = {light_.data(), static_cast<uint32_t>(light_.size())};
  view.eye = eye;
  view.edge_per_metre = edge_per_metre;
  return view;
}

}  // namespace gloam

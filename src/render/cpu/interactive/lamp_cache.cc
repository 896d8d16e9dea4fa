#include "render/cpu/interactive/lamp_cache.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "render/cpu/interactive/gather_lanes.h"

namespace gloam {
namespace {

bool has_moved(const LightView& now, const LightView& before) {
  return now.first_key >= 0 || now.kind != before.kind || now.instance != before.instance ||
         length_squared(now.p - before.p) > 0 ||
         length_squared(now.direction - before.direction) > 0;
}

/// Light of a lamp at a cell, relative to the brightest.
uint8_t relative_weight(float weight, float brightest) {
  return static_cast<uint8_t>(clamp(255 * weight / max(brightest, 1e-30f), 1.0f, 255.0f));
}

/// Adds the result of a ray to a list. Where the list is full, it takes the place of the lamp that
/// brings least light, of hidden ones before others.
void record(uint32_t lamp, uint8_t seen, float weight, LampCell* cell) {
  const uint16_t row = static_cast<uint16_t>(lamp);
  uint16_t* const end = cell->lamp + cell->count;
  auto at = static_cast<size_t>(std::lower_bound(cell->lamp, end, row) - cell->lamp);
  if (at < cell->count && cell->lamp[at] == row) {
    cell->seen[at] |= seen;
    cell->weight[at] = std::max(cell->weight[at], relative_weight(weight, cell->brightest));
    return;
  }
  if (cell->count == LampCell::kMost) {
    const auto worth = [&](uint32_t i) {
      return cell->weight[i] + (cell->is_visible(i) ? 256 : 0);
    };
    uint32_t least = 0;
    for (uint32_t i = 1; i < cell->count; ++i)
      if (worth(i) < worth(least)) least = i;
    const int mine =
        relative_weight(weight, cell->brightest) + ((seen & LampCell::kClear) ? 256 : 0);
    if (worth(least) >= mine) return;
    const auto remove = [&](auto* list) {
      std::copy(list + least + 1, list + cell->count, list + least);
    };
    remove(cell->lamp), remove(cell->seen), remove(cell->weight);
    --cell->count;
    if (least < at) --at;
  }
  const auto insert = [&](auto* list, auto value) {
    std::copy_backward(list + at, list + cell->count, list + cell->count + 1);
    list[at] = value;
  };
  insert(cell->lamp, row);
  insert(cell->seen, seen);
  insert(cell->weight, relative_weight(weight, cell->brightest));
  ++cell->count;
}

/// Takes a lamp from a list.
void hide(uint32_t lamp, LampCell* cell) {
  for (uint32_t i = 0; i < cell->count; ++i) {
    if (cell->lamp[i] != lamp || !cell->is_visible(i)) continue;
    cell->seen[i] = LampCell::kHidden;
    --cell->visible;
  }
}

/// A ray from a place to a point of a lamp.
uint8_t look_at(const SceneView& scene, const CpuTracer& fixed, const CacheRequest& from,
                uint32_t lamp, Vec2f u, uint32_t* rays) {
  const LightSample light = sample_one_light<float>(scene, lamp, from.p, u, 0.0f, true);
  if (!(light.pdf > 0) || !(dot(light.wi, from.n) > 0)) return LampCell::kHidden;
  if (!light.casts_shadow) return LampCell::kClear;
  Ray shadow;
  aim_shadow_ray(from.p, from.n, 0.0f, light, &shadow);
  const Vec3f passed = paths::transmit(scene, fixed, shadow, true, rays);
  if (!(max_component(passed) > 0)) return LampCell::kHidden;
  const bool dims = passed.x < 1 || passed.y < 1 || passed.z < 1;
  return dims ? LampCell::kHidden | LampCell::kClear : LampCell::kClear;
}

}  // namespace

void LampCache::follow(const SceneView& scene) {
  const uint32_t count = scene.lights.size;
  bool stays = lights_.size() == count;
  for (uint32_t i = 0; stays && i < count; ++i)
    stays = scene.lights[i].strength <= interactive::kMaxLampGrowth * strengths_[i];
  if (!stays) {
    *this = {};
    for (uint32_t i = 0; i < count; ++i) strengths_.push_back(scene.lights[i].strength);
    moves_.assign(count, false);
  }
  for (uint32_t i = 0; i < count; ++i) {
    const LightView& now = scene.lights[i];
    if (moves_[i] || !(now.first_key >= 0 || (stays && has_moved(now, lights_[i])))) continue;
    moves_[i] = true;
    movable_.push_back(static_cast<uint16_t>(i));
    for (LampCell& list : lists_) hide(i, &list);
  }
  lights_.assign(scene.lights.data, scene.lights.data + count);
}

void LampCache::ask(const std::vector<CacheRequest>& requests) {
  for (const CacheRequest& request : requests) {
    if (request.key == 0) continue;
    const uint32_t row = index_.find_or_add(request.key);
    if (row == cells_.size()) {
      cells_.push_back({request.key});
      lists_.emplace_back();
      starts_.resize(cells_.size() * kStarts);
    }
    Cell& cell = cells_[row];
    cell.last_asked = update_;
    const auto count = static_cast<uint32_t>(cell.starts++);
    // If more places ask, each update keeps different ones.
    const uint32_t place = count < kStarts ? count : mix_bits(count ^ update_ << 16) % (count + 1);
    if (place < kStarts) starts_[row * kStarts + place] = request;
  }
}

uint64_t LampCache::trace_cell(const SceneView& scene, const CpuTracer& fixed, uint64_t seed,
                               uint32_t row) {
  Cell& cell = cells_[row];
  LampCell& list = lists_[row];
  const uint32_t count = scene.lights.size;
  const bool is_new = cell.rounds == 0;
  const bool has_many = count > interactive::kMaxFastLights;
  const int starts = std::min(cell.starts, is_new && !has_many ? kStarts : 1);
  std::vector<float> weights(count);
  std::vector<uint32_t> order;
  uint32_t rays = 0;
  for (int s = 0; s < starts; ++s) {
    const CacheRequest& from = starts_[row * kStarts + static_cast<size_t>(s)];
    float left = 0;
    order.clear();
    for (uint32_t i = 0; i < count; ++i) {
      if (moves_[i]) continue;
      weights[i] = light_weight<float>(scene, scene.lights[i], from.p, from.n);
      if (!(weights[i] > 0)) continue;
      left += weights[i];
      order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return weights[a] > weights[b]; });
    if (is_new && s == 0 && !order.empty()) list.brightest = weights[order.front()];
    Sampler sampler = Sampler::make(seed ^ cell.key * 0x9E3779B97F4A7C15ull,
                                    cell.rounds + static_cast<uint32_t>(s), 0, 0, 0, 0);
    float seen = 0;
    // Known cells look at a few of many lamps each time, and at others the next time.
    const auto strides =
        is_new ? 1 : static_cast<uint32_t>(order.size()) / interactive::kLampsLookedAt + 1;
    for (size_t k = cell.rounds % strides; k < order.size(); k += strides) {
      const uint32_t i = order[k];
      if (strides == 1 && left < interactive::kNegligibleLamps * seen) break;
      const uint8_t result = look_at(scene, fixed, from, i, sampler.next_2d(), &rays);
      record(i, result, weights[i], &list);
      if (result & LampCell::kClear) seen += weights[i];
      left -= weights[i];
    }
  }
  list.visible = 0;
  for (uint32_t i = 0; i < list.count; ++i) list.visible += list.is_visible(i);
  cell.rounds += static_cast<uint32_t>(starts);
  cell.last_traced = update_;
  return rays;
}

uint64_t LampCache::update(const SceneView& scene, const CpuTracer& tracer, uint64_t seed,
                           size_t most_old, RenderWatch* watch) {
  std::vector<uint32_t> asked;
  size_t made = 0;
  for (uint32_t row = 0; row < cells_.size(); ++row) {
    if (cells_[row].starts == 0) continue;
    asked.push_back(row);
    made += cells_[row].rounds == 0;
  }
  const auto waits = [this](uint32_t row) {
    return cells_[row].rounds == 0 ? ~0u : update_ - cells_[row].last_traced;
  };
  std::stable_sort(asked.begin(), asked.end(),
                   [&](uint32_t a, uint32_t b) { return waits(a) > waits(b); });
  asked.resize(std::min(asked.size(), made + most_old));
  const CpuTracer fixed = tracer.fixed_part();
  std::vector<uint64_t> rays(asked.size());
  constexpr size_t kTask = 32;  // cells
  watch->slices().run("lamp cells", static_cast<int64_t>((asked.size() + kTask - 1) / kTask),
                      [&](int64_t task) {
                        const size_t begin = static_cast<size_t>(task) * kTask;
                        const size_t end = std::min(begin + kTask, asked.size());
                        for (size_t k = begin; k < end && watch->may_continue(); ++k)
                          rays[k] = trace_cell(scene, fixed, seed, asked[k]);
                      });
  forget_old();
  return std::accumulate(rays.begin(), rays.end(), uint64_t{0});
}

void LampCache::forget_old() {
  ++update_;
  for (Cell& cell : cells_) cell.starts = 0;
  if (drop_old_cells(update_, interactive::kLampCellLifetime, &cells_, &lists_) == 0) return;
  starts_.resize(cells_.size() * kStarts);
  index_.assign(cells_);
}

LampCellsView LampCache::view(Vec3f eye, float edge_per_metre) const {
  LampCellsView view{index_.grid(eye, edge_per_metre)};
  view.lists = {lists_.data(), static_cast<uint32_t>(lists_.size())};
  view.movable = {movable_.data(), static_cast<uint32_t>(movable_.size())};
  return view;
}

}  // namespace gloam

#include "render/cpu/interactive/irradiance_cache.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "render/cpu/interactive/gather_lanes.h"
#include "render/kernel/light/light_directions.h"

namespace gloam {

void IrradianceCache::ask(const std::vector<CacheRequest>& requests, size_t most) {
  for (const CacheRequest& request : requests) {
    if (request.key == 0) continue;
    if (cells_.size() >= most && index_.find(request.key) < 0) continue;
    const uint32_t row = index_.find_or_add(request.key);
    if (row == cells_.size()) {
      cells_.push_back({request.key});
      light_.push_back(CellLight::unknown(mean_));
      homes_.emplace_back();
      starts_.resize(cells_.size() * kStarts);
    }
    Cell& cell = cells_[row];
    cell.last_asked = update_;
    // Reservoir of starts: some of many places that ask, by chance, so that rays start all over the
    // cell.
    const auto count = static_cast<uint32_t>(cell.starts++);
    const uint32_t place = count < kStarts ? count : next_random() % (count + 1);
    if (place < kStarts) starts_[row * kStarts + place] = request;
  }
}

uint32_t IrradianceCache::next_random() {
  random_state_ = random_state_ * 6364136223846793005ull + 1442695040888963407ull;
  return static_cast<uint32_t>(random_state_ >> 33);
}

float IrradianceCache::luminance_beside(uint64_t key) const {
  float sum = 0, rays = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool up : {false, true}) {
      const int row = index_.find(caches::beside(key, axis, up));
      if (row < 0) continue;
      const auto weight = static_cast<float>(cells_[static_cast<size_t>(row)].samples);
      sum += luminance(light_[static_cast<size_t>(row)].all) * weight;
      rays += weight;
    }
  }
  return rays > 0 ? sum / rays : luminance(mean_);
}

namespace {

/// Directions about z by Henyey and Greenstein's phase function, of the mean cosines g, and their
/// densities per solid angle.
Vec3Of<FloatLanes> phase_direction(FloatLanes g, Vec2Of<FloatLanes> u) {
  FloatLanes cosine, s, c;
  for (int i = 0; i < kLaneCount; ++i) {
    set_lane(&cosine, i, sample_henyey_greenstein(lane(g, i), 1 - lane(u.x, i)));
  }
  sincos_turn(u.y, &s, &c);
  const FloatLanes r = safe_sqrt(1.0f - cosine * cosine);
  return {r * c, r * s, cosine};
}
FloatLanes phase_density(FloatLanes g, FloatLanes cosine) {
  FloatLanes pdf;
  for (int i = 0; i < kLaneCount; ++i) {
    set_lane(&pdf, i, henyey_greenstein(lane(g, i), lane(cosine, i)));
  }
  return pdf;
}

}  // namespace

void IrradianceCache::find_home(const CpuTracer& tracer, uint32_t row) {
  const Cell& cell = cells_[row];
  if (!caches::is_air(cell.key) || cell.rounds > 0) return;
  CacheRequest* starts = starts_.data() + row * kStarts;
  AirHome& home = homes_[row];
  home = {starts->p};
  // Places ask a cell from up to as far around it.
  const Vec3f middle = caches::middle_of(cell.key);
  const float reach = caches::edge_of(cell.key);
  for (int corner = 0; corner < 8 && home.sees_all; ++corner) {
    const Vec3f to{corner & 1 ? reach : -reach, corner & 2 ? reach : -reach,
                   corner & 4 ? reach : -reach};
    home.sees_all = caches::is_clear(tracer, home.p, middle + to);
  }
  if (home.sees_all) return;
  for (CacheRequest& start : std::span(starts, std::min(cell.starts, kStarts))) {
    if (!caches::is_clear(tracer, home.p, start.p)) start = *starts;
  }
}

void IrradianceCache::trace_cell(const SceneView& scene, const CpuTracer& tracer,
                                 IrradianceCacheView cache, uint64_t seed, int rays, size_t k) {
  using F = FloatLanes;
  const uint32_t row = asked_[k];
  const Cell& cell = cells_[row];
  // Light of the cell itself: the best guess for cells around it that are not known.
  if (cell.samples > 0) cache.mean = light_[row].all;
  const float edge = caches::edge_of(cell.key);
  const bool in_air = caches::is_air(cell.key);
  // Luminance at least as bright as the cells beside: a cell that has met too little would cut off
  // what it lacks, for good.
  const float beside = luminance_beside(cell.key);
  const float own = cell.samples == 0 ? beside : luminance(light_[row].all);
  const float usual = max(own, beside);
  const auto starts = static_cast<size_t>(std::min(cell.starts, kStarts));
  const float brightest =
      usual > 0 ? (in_air ? interactive::kBrightestInAir : interactive::kBrightest) * usual : 1e30f;
  const float per_ray = 1 / static_cast<float>(rays);
  const InteractiveWorld<CpuTracer> world{scene, tracer, cache};
  Traced& out = traced_[k];
  out = {};
  out.is_new = cell.samples == 0;
  out.before = own, out.usual = usual;
  for (int first = 0; first < rays; first += kLaneCount) {
    paths::State<F> path;
    UintLanes index;
    const uint32_t begin = cell.rounds % interactive::kRoundsPerPointSet * interactive::kRays +
                           static_cast<uint32_t>(first);
    for (int i = 0; i < kLaneCount; ++i) set_lane(&index, i, begin + static_cast<uint32_t>(i));
    const uint64_t mixed = cell.key * 0x9E3779B97F4A7C15ull;
    // Rays of one round after the other go on with the same points: all that a mean is of are
    // spread evenly.
    path.sampler = SamplerOf<F>::make(seed ^ mixed, cell.rounds / interactive::kRoundsPerPointSet,
                                      UintLanes(0u), UintLanes(0u), index, 0);
    path.throughput = in_all_lanes<F>({1, 1, 1});
    // Each stratum is a part of a ring: over compact patches of directions a rare bright lamp left
    // spots.
    const Vec2Of<F> u = path.sampler.next_2d();
    const Vec2Of<F> u_lamp = path.sampler.next_2d(), u_walk = path.sampler.next_2d();
    Vec3Of<F> normal;
    F g;
    MaskLanes seeks = false;
    for (int i = 0; i < kLaneCount; ++i) {
      const CacheRequest& start = starts_[row * kStarts + static_cast<size_t>(first + i) % starts];
      set_lane(&path.ray.o, i, start.p);
      set_lane(&normal, i, start.n);
      set_lane(&g, i, start.g);
      set_lane(&seeks, i, (first + i) / interactive::kRaysPerBatch % 2 != 0);
    }
    const Vec3Of<F> local = in_air ? phase_direction(g, u) : cosine_direction(u);
    path.ray.d = FrameOf<F>::from_z(normal).to_world(local);
    F weight = 1.0f;
    if (scene.guides_directions()) {
      const GuideRowsOf<F> rows = find_rows<F>(scene.guide, path.ray.o, normal, true);
      path.ray.d =
          select<F>(seeks & rows.guided, directions::sample(scene.guide, rows.row, u), path.ray.d);
      const F cosine = dot(path.ray.d, normal);
      const F even = in_air ? phase_density(g, cosine) : max(cosine, 0.0f) * kInvPi;
      const F sought = directions::pdf(scene.guide, rows.row, path.ray.d);
      weight = select(rows.guided, 2.0f * even / max(even + sought, F(1e-9f)), F(1.0f));
    }
    path.cone_spread = interactive::kRayConeSpread;
    const Vec3Of<F> origin = path.from = path.ray.o;
    CacheRequest met[kLaneCount];
    interactive::GatherOptionsOf<F> options;
    options.near_lamp = in_air ? interactive::kNearLamp : 0.0f;
    options.near_flames = !in_air;
    const interactive::GatheredOf<F> light =
        interactive::gather<F>(world, options, weight > 0.0f, &path, met);
    for (int i = 0; i < kLaneCount; ++i) {
      const float w = lane(weight, i);
      Vec3f all = w > 0 ? lane(light.light, i) * w : Vec3f{}, lamps;
      if (in_air) {
        Ray ray = lane(path.ray, i);
        ray.o = lane(origin, i);
        ray.d = lane(normal, i);
        WalkRandom random(lane(u_walk, i));
        uint32_t shadow = 0;
        lamps = interactive::lamps_in_air(scene, tracer, ray, lane(g, i), lane(u_lamp, i), &random,
                                          &shadow);
        out.rays += shadow;
        all += lamps;
      }
      const float kept = brightest / max(luminance(all), brightest);
      const Vec3f one = all * kept;
      out.excess += all - one;
      const bool near = !in_air && lane(light.distance, i) < edge;
      out.light.all += one;
      if (near) out.light.near += one;
      out.light.near += lamps * kept;
      out.light.near_fraction += near ? w : 0.0f;
      if (lane(light.distance, i) < 1e30f && scene.instances[lane(light.first, i)].has_moved)
        out.stir += w * per_ray;
      out.variance += sqr(luminance(one));
      out.rays += lane(path.result.rays, i);
    }
    if (first == 0) std::copy_n(met, kFurther, &further_[k * kFurther]);
  }
  CellLight& light = out.light;
  light = {light.all * per_ray, light.near * per_ray, light.near_fraction * per_ray};
  out.excess = out.excess * per_ray;
  out.variance = max(out.variance * per_ray - sqr(luminance(light.all)), 0.0f) * per_ray;
}

IrradianceCache::LightChange IrradianceCache::change_of(
    std::span<const KeyGroups::Member> group) const {
  LightChange sum;
  for (const auto& [key, k] : group) {
    if (traced_[k].is_new) continue;
    const float past = luminance(light_[asked_[k]].all);
    sum.light += past;
    sum.change += luminance(traced_[k].light.all) - past;
    // Variance of these few rays, or of earlier ones if that is greater: cells that met few of the
    // bright ones would count as changed.
    sum.variance += max(traced_[k].variance, cells_[asked_[k]].variance);
  }
  return sum;
}

void IrradianceCache::find_changes() {
  // Few rays of one cell say little; those of a region together tell a change of the light from
  // noise.
  const auto key_of = [&](size_t k) { return cells_[asked_[k]].key; };
  groups_.each(traced_.size(), caches::kRegion, key_of, [&](auto group) {
    const LightChange sum = change_of(group);
    const bool changed = fabsf(sum.change) > interactive::kChangeSigma * sqrtf(sum.variance) +
                                                 interactive::kNoRegionChange * sum.light;
    for (const auto& [key, k] : group) traced_[k].changed = changed && !traced_[k].is_new;
  });
  // Light that fades everywhere shows here long before it shows in each region.
  groups_.each(traced_.size(), 0, key_of, [&](auto group) {
    const LightChange sum = change_of(group);
    if (fabsf(sum.change) > interactive::kChangeSigma * sqrtf(sum.variance) +
                                interactive::kGlobalChangeThreshold * sum.light) {
      for (Traced& traced : traced_) traced.changed = true;
    }
  });
}

uint64_t IrradianceCache::trace(const CellRays& rays, bool remembers, RenderWatch* watch) {
  const IrradianceCacheView cache = view(rays.eye, rays.edge_per_metre);
  traced_.resize(asked_.size());
  further_.assign(asked_.size() * kFurther, {});
  parallel_for_range("homes of cells", static_cast<int64_t>(asked_.size()), 64,
                     [&](int64_t begin, int64_t end) {
                       for (int64_t k = begin; k < end; ++k)
                         find_home(rays.tracer, asked_[static_cast<size_t>(k)]);
                     });
  constexpr size_t kTask = 4;  // cells
  watch->slices().run("irradiance cache", static_cast<int64_t>((asked_.size() + kTask - 1) / kTask),
                      [&](int64_t task) {
                        const size_t begin = static_cast<size_t>(task) * kTask;
                        const size_t end = std::min(begin + kTask, asked_.size());
                        for (size_t k = begin; k < end && watch->may_continue(); ++k)
                          trace_cell(rays.scene, rays.tracer, cache, rays.seed,
                                     remembers ? interactive::kRays : interactive::kFirstRays, k);
                      });
  of_cells_.clear();
  for (size_t k = 0; k < traced_.size(); ++k) {
    of_cells_.push_back({cells_[asked_[k]].key, traced_[k].excess, traced_[k].usual});
  }
  spread_.resize(traced_.size());
  excess_.spread(of_cells_, remembers, spread_);
  for (size_t k = 0; k < traced_.size(); ++k) traced_[k].light.all += spread_[k];
  find_changes();
  uint64_t count = 0;
  for (size_t k = 0; k < asked_.size(); ++k) {
    const Traced& traced = traced_[k];
    Cell& cell = cells_[asked_[k]];
    CellLight& light = light_[asked_[k]];
    // Light from before is no part of the mean as long as little of the light has come round.
    if (!remembers || traced.changed) cell.samples = std::min(cell.samples, interactive::kRays / 8);
    if (!remembers) cell.samples = 0;
    if (traced.changed) excess_.forget(cell.key);
    ++cell.rounds;
    cell.stir = max(traced.stir, interactive::kMotionDecay * cell.stir);
    const auto memory = static_cast<int>(interactive::kMaxCellRays /
                                         (1 + interactive::kMotionMemoryDivisor * cell.stir));
    cell.samples = std::min(cell.samples, std::max(memory - interactive::kRays, 0));
    const float weight = static_cast<float>(interactive::kRays) /
                         static_cast<float>(cell.samples + interactive::kRays);
    light = light.is_known() ? lerp(light, traced.light, weight) : traced.light;
    cell.variance = lerp(cell.variance, traced.variance, weight);
    cell.samples = std::min(cell.samples + interactive::kRays, interactive::kMaxCellRays);
    cell.last_traced = update_;
    count += traced.rays;
  }
  // Geometric mean, as few cells out of doors are as bright as all in a room together.
  Vec3f sum;
  float logs = 0, known = 0;
  for (const CellLight& light : light_) {
    const float l = luminance(light.all);
    if (!light.is_known() || !(l > 0)) continue;
    sum += light.all;
    logs += logf(l);
    ++known;
  }
  mean_ = known > 0 ? sum * (expf(logs / known) / luminance(sum)) : Vec3f{};
  return count;
}

double IrradianceCache::extrapolate(int round, bool remembers) {
  // Light that comes round once more in each of them dies away as a geometric series: its sum is
  // known from two terms (Aitken 1926).
  const auto counts = [&](size_t k) {
    return !traced_[k].is_new && (!remembers || traced_[k].changed);
  };
  double change = 0, light = 0, cells = 0;
  for (size_t k = 0; k < asked_.size(); ++k) {
    if (!counts(k)) continue;
    ++cells;
    light += luminance(light_[asked_[k]].all);
    change += luminance(light_[asked_[k]].all) - traced_[k].before;
  }
  change /= max(cells, 1.0);  // of each, as cells come to be known from round to round
  light /= max(cells, 1.0);
  const double quotient = change / std::exchange(last_change_, change);
  const double last_quotient = std::exchange(last_quotient_, quotient);
  terms_ = round == 0 ? 1 : terms_ + 1;
  const double relative_change = light > 0 ? std::abs(change) / light : 1;
  // Two quotients that agree tell it from noise. While a picture waits there is time for one.
  const double ratio = remembers ? quotient : std::min(quotient, last_quotient);
  const auto dies = [](double r) { return r > 0 && r < interactive::kMaxSeriesRatio; };
  if (terms_ < (remembers ? 3 : 4) || relative_change <= interactive::kMinSeriesGain)
    return relative_change;
  if (!dies(quotient) || !(remembers || dies(last_quotient))) return relative_change;
  const auto factor = static_cast<float>(std::max(0.0, 1 + change * ratio / ((1 - ratio) * light)));
  for (size_t k = 0; k < asked_.size(); ++k) {
    if (!counts(k)) continue;
    CellLight& cell = light_[asked_[k]];
    cell.all = cell.all * factor;
    cell.near = cell.near * factor;
  }
  terms_ = 0;
  return relative_change;
}

uint64_t IrradianceCache::update(const CellRays& rays, bool settles, CellBudget budget,
                                 RenderWatch* watch) {
  uint64_t count = 0;
  bool remembers = !settles;
  int rounds = settles ? kFirstRounds : 1;
  double last_change = 1;
  // Cells are limited: where each ray meets a leaf of its own, larger cells' light stands for what
  // lies further on.
  const size_t most =
      interactive::kFurtherMargin +
      interactive::kFurtherCells *
          static_cast<size_t>(std::count_if(cells_.begin(), cells_.end(),
                                            [](const Cell& cell) { return cell.starts > 0; }));
  for (int i = 0; i < rounds && !watch->stopped(); ++i) {
    ask(std::vector<CacheRequest>(std::move(further_)), most);
    asked_.clear();
    for (uint32_t row = 0; row < cells_.size(); ++row) {
      if (cells_[row].starts > 0) asked_.push_back(row);
    }
    // Cells that have waited longest, above all where things move, and new ones before all; among
    // equals in the order of their making.
    const auto waits = [this](uint32_t row) {
      const Cell& cell = cells_[row];
      if (cell.samples == 0) return 1e9f;
      return static_cast<float>(update_ - cell.last_traced) *
             (1 + interactive::kMotionMemoryDivisor * cell.stir);
    };
    std::stable_sort(asked_.begin(), asked_.end(),
                     [&](uint32_t a, uint32_t b) { return waits(a) > waits(b); });
    if (!settles && i == 0) {
      // Cells whose light has come to rest are looked at less often, until it changes in many.
      const auto is_settled = [this](uint32_t row) {
        return !light_changes_ && 2 * cells_[row].samples >= interactive::kMaxCellRays &&
               cells_[row].stir < interactive::kStirred;
      };
      const auto settled =
          static_cast<size_t>(std::count_if(asked_.begin(), asked_.end(), is_settled));
      const size_t looked_at = asked_.size() - settled + std::min(settled, budget.settled);
      asked_.resize(std::min(looked_at, budget.most));
    }
    count += trace(rays, remembers, watch);
    watch->tile_done();
    // A lamp went on or off: what it sends comes round by one reflection each time.
    const auto changed = std::count_if(traced_.begin(), traced_.end(),
                                       [](const Traced& traced) { return traced.changed; });
    const bool many = light_changes_ =
        !settles && 8 * changed > static_cast<int64_t>(asked_.size());
    if (remembers && !many) continue;
    const double relative_change = extrapolate(i, remembers);
    if (many && rounds < interactive::kMostRounds) ++rounds;
    const bool rests = relative_change < interactive::kConvergenceThreshold &&
                       last_change < interactive::kConvergenceThreshold;
    last_change = relative_change;
    if (settles && ((i > 1 && rests) || i + 1 + interactive::kMeanRounds == kFirstRounds)) {
      remembers = true;
      rounds = i + 1 + interactive::kMeanRounds;
    }
  }
  forget();
  return count;
}

void IrradianceCache::forget() {
  ++update_;
  excess_.end_update(interactive::kCellLifetime);
  for (Cell& cell : cells_) cell.starts = 0;
  if (drop_old_cells(update_, interactive::kCellLifetime, &cells_, &light_, &homes_) == 0) return;
  starts_.resize(cells_.size() * kStarts);
  index_.assign(cells_);
}

IrradianceCacheView IrradianceCache::view(Vec3f eye, float edge_per_metre) const {
  IrradianceCacheView view{index_.grid(eye, edge_per_metre)};
  view.light = {light_.data(), static_cast<uint32_t>(light_.size())};
  view.homes = {homes_.data(), static_cast<uint32_t>(homes_.size())};
  view.mean = mean_;
  return view;
}

}  // namespace gloam

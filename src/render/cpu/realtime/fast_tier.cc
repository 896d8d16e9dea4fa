#include "render/cpu/realtime/fast_tier.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Fraction of directions that meet a near surface, by the four by four pixels about one, whose
/// directions are spread evenly: one alone has all or nothing.
F mean_near(const FastFrame& f, int x, int y) {
  const F part = f.part.load(x, y);
  const Vec3Of<F> p = f.p.load(x, y), n = f.n.load(x, y);
  const F scale = 1.0f / (realtime::kNearTolerance * f.distance.load(x, y) + 1e-4f);
  F sum, total;
  for (int dy = -1; dy <= 2; ++dy) {
    for (int dx = -1; dx <= 2; ++dx) {
      const F same = select(f.part.load(x + dx, y + dy) == part, F(1.0f), F(0.0f));
      const F facing = sqr(max(dot(n, f.n.load(x + dx, y + dy)), 0.0f));
      const F off = dot(n, f.p.load(x + dx, y + dy) - p) * scale;
      const F weight = same * sqr(sqr(facing)) * max(1.0f - off * off, 0.0f);
      sum += f.near.load(x + dx, y + dy) * weight;
      total += weight;
    }
  }
  return sum / max(total, F(1e-6f));
}

float cell_edge(const CameraView32& camera) {
  return min(realtime::kCellPixels / camera.fx, realtime::kWidestCell);
}

float lamp_cell_edge(const CameraView32& camera) {
  return min(realtime::kLampCellPixels / camera.fx, realtime::kWidestCell);
}

/// Our own BVH does not trace what moves apart from the rest.
bool has_lamp_lists(const Job& job) {
  return !job.tracer.own && job.scene.lights.size > 0 &&
         job.scene.lights.size <= LampCache::kMostLights;
}

}  // namespace

bool FastHistory::find_moving_lamps(const SceneView& scene) {
  // Lamps that move less far from picture to picture, or give less than kMinLampStrength of the
  // strongest lamp's light, are left to the cache, which follows them.
  std::vector<LampPlace> now;
  float strongest = 0;
  for (uint32_t i = 0; i < scene.lights.size; ++i) {
    const LightView& light = scene.lights[i];
    now.push_back({light.p, light.direction});
    if (light.kind != LightKind::kDirectional) strongest = max(strongest, light.strength);
  }
  // Lamps that go on or out change the rows, so none can be followed; cells notice such changes.
  bool moves = false;
  for (uint32_t i = 0; !moves && now.size() == lamps_.size() && i < scene.lights.size; ++i) {
    moves = scene.lights[i].strength > realtime::kMinLampStrength * strongest &&
            (length(now[i].p_W - lamps_[i].p_W) > realtime::kMaxLampShift ||
             length(now[i].direction - lamps_[i].direction) > realtime::kMaxLampTurn);
  }
  lamps_ = std::move(now);
  return moves;
}

void FastHistory::look_up(const IrradianceCacheView& cache) {
  parallel_for("fast light", now_.height, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < now_.width; x += kLaneCount) {
      const F near = mean_near(now_, x, y);
      for (int i = 0; i < kLaneCount && x + i < now_.width; ++i) {
        const int cell = find_cell(cache, now_.key[static_cast<size_t>(y) * now_.width + x + i]);
        now_.signal[kCachedSignal].set(
            x + i, y,
            cell >= 0 ? light_at(cache.light[static_cast<uint32_t>(cell)], lane(near, i))
                      : Vec3f{});
      }
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
      Vec3Of<F> color = now_.base.load(x, y) + now_.albedo.load(x, y) * diffuse +
                        now_.gloss.load(x, y) * cached + specular;
      if (now_.signals > kAirSignal) color += filter_.smoothed(kAirSignal).load(x, y);
      now_.color.store(x, y, color);
      const MaskLanes moves =
          !((now_.motion_x.load(x, y) == F(0.0f)) & (now_.motion_y.load(x, y) == F(0.0f)));
      const F gleam = 0.5f * luminance(specular) / max(luminance(color), F(1e-6f));
      now_.gleam.store(
          x, y,
          select(moves & (now_.roughness.load(x, y) < realtime::kSharpMirror), gleam, F(0.0f)));
    }
  });
}

void FastHistory::add_picture(const Job& job, uint32_t pass, RenderWatch* watch) {
  const Vec3f eye = job.camera.pose.X_WC_open.p;
  const uint64_t seed = job.settings.seed;
  const CpuTracer movers = job.tracer.moving_part();
  for (bool again = true; again && !watch->stopped();) {
    const bool first = cache_.size() == 0;
    const float edge = cell_edge(job.camera) * coarse_;
    IrradianceCacheView cache = cache_.view(eye, edge);
    cache.lamps_move = lamps_move_;
    std::optional<LampCellsView> lamps;
    if (has_lamp_lists(job)) lamps = lamp_cells_.view(eye, lamp_cell_edge(job.camera));
    trace({job.scene, job.tracer, movers, job.camera, cache, lamps, seed}, pass, job.slices);
    if (lamps) {
      lamp_cells_.ask(lamp_requests_);
      rays_ += lamp_cells_.update(job.scene, job.tracer, seed, realtime::kOldLampCells, watch);
    }
    cache_.ask(requests_);
    if (first && cache_.size() > realtime::kMaxFirstCells && coarse_ < realtime::kMaxEdgeFactor) {
      coarse_ *= 2;
      cache_ = {};
      continue;
    }
    again = first;  // a first picture is traced twice: its rays saw no cache
    rays_ += cache_.update(
        job.scene, job.tracer, eye, edge, seed, first,
        pictures_ < realtime::kFirstPictures ? realtime::kFirstCells : realtime::kMostCells, watch);
    if (requests_.empty()) break;
  }
  look_up(cache_.view(eye, cell_edge(job.camera) * coarse_));
  now_.signals = job.scene.media.volumes.empty() ? kAirSignal : kFastSignals;
  filter_.accumulate(before_, &now_);
  job.slices->pause();
  filter_.smooth(now_);
  compose();
  job.slices->pause();
  resolve(before_, &filter_.color_gain, &now_);
  std::swap(now_, before_);
  ++pictures_;
}

RenderStats FastHistory::render(const Job& job) {
  Film* const film = job.film;
  rays_ = 0;
  if (film->width != now_.width || film->height != now_.height) {
    now_.resize(film->width, film->height);
    before_.resize(film->width, film->height);
    filter_.resize(film->width, film->height);
    pictures_ = 0;
    coarse_ = 1;
  }
  const bool first = pictures_ == 0;
  lamps_move_ = find_moving_lamps(job.scene);
  lamp_cells_.follow(job.scene);
  const uint32_t passes = first ? realtime::kFirstPictures : 1;
  RenderWatch watch(job.settings.progress,
                    first ? IrradianceCache::kFirstRounds + realtime::kFirstPictures : 1,
                    *job.slices);
  for (uint32_t pass = 0; pass < passes && !watch.stopped(); ++pass) add_picture(job, pass, &watch);
  parallel_for("fast film", film->height, [&](int64_t y) {
    for (int x = 0; x < film->width; ++x) {
      film->radiance[static_cast<size_t>(y) * film->width + x] =
          before_.resolved.get(x, static_cast<int>(y));
    }
  });
  RenderStats stats;
  stats.paths = film->pixel_count();
  stats.rays = rays_;
  stats.finished = !watch.stopped();
  if (!stats.finished) *this = {};  // what it remembers is unfinished, too
  return stats;
}

}  // namespace gloam

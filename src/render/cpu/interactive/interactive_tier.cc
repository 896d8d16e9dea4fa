#include "render/cpu/interactive/interactive_tier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "render/cpu/interactive/light_store.h"

namespace gloam {
namespace {

using F = FloatLanes;

/// Fraction of directions that meet a near surface, by the four by four pixels about one, whose
/// directions are spread evenly: one alone has all or nothing.
F mean_near(const InteractiveFrame& f, int x, int y) {
  const F part = f.part.load(x, y);
  const Vec3Of<F> p = f.p.load(x, y), n = f.n.load(x, y);
  const F scale = 1.0f / (interactive::kNearTolerance * f.distance.load(x, y) + 1e-4f);
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
  return min(interactive::kCellPixels / camera.fx, interactive::kWidestCell);
}

float lamp_cell_edge(const CameraView32& camera) {
  return min(interactive::kLampCellPixels / camera.fx, interactive::kWidestCell);
}

/// Pixels of a frame for an image.
int frame_pixels(int image_pixels) {
  return std::max(
      static_cast<int>(std::lround(static_cast<float>(image_pixels) * interactive::kFrameScale)),
      1);
}

/// The camera with another resolution.
CameraView32 scaled(CameraView32 camera, float across, float down) {
  camera.fx *= across, camera.cx *= across;
  camera.fy *= down, camera.cy *= down;
  return camera;
}

/// Our own BVH does not trace what moves apart from the rest.
bool has_lamp_lists(const Job& job) {
  return !job.tracer.own && job.scene.lights.size > 0 &&
         job.scene.lights.size <= LampCache::kMostLights;
}

}  // namespace

bool InteractiveHistory::find_moving_lamps(const SceneView& scene) {
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
    moves = scene.lights[i].strength > interactive::kMinLampStrength * strongest &&
            (length(now[i].p_W - lamps_[i].p_W) > interactive::kMaxLampShift ||
             length(now[i].direction - lamps_[i].direction) > interactive::kMaxLampTurn);
  }
  lamps_ = std::move(now);
  return moves;
}

void InteractiveHistory::look_up(const IrradianceCacheView& cache) {
  parallel_for("interactive light", now_.height, [&](int64_t row) {
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

void InteractiveHistory::compose() {
  parallel_for("interactive picture", now_.height, [&](int64_t row) {
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
          select(moves & (now_.roughness.load(x, y) < interactive::kSharpMirror), gleam, F(0.0f)));
    }
  });
}

size_t InteractiveHistory::budget(size_t cells) const {
  const auto pixels = static_cast<size_t>(image_.width) * static_cast<size_t>(image_.height);
  return std::max(cells * pixels / interactive::kBudgetPixels, interactive::kLeastCells);
}

void InteractiveHistory::add_frame(const Job& job, const CameraView32& camera, uint32_t pass,
                                   RenderWatch* watch) {
  const Vec3f eye = job.camera.pose.X_WC_open.p;
  const uint64_t seed = job.settings.seed;
  const CpuTracer movers = job.tracer.moving_part();
  const CellBudget cells{budget(interactive::kSettledCells), pictures_ < interactive::kFirstPictures
                                                                 ? interactive::kFirstCells
                                                                 : interactive::kMostCells};
  uint64_t key = 0;  // of the first light on disk
  if (pictures_ == 0 && cache_.size() == 0) {
    key = light_key(job.scene, job.camera, image_.width, image_.height, seed);
    load_first_light(key);
  }
  for (bool again = true; again && !watch->stopped();) {
    const bool first = cache_.size() == 0;
    const float edge = cell_edge(job.camera) * coarse_;
    IrradianceCacheView cache = cache_.view(eye, edge);
    cache.lamps_move = lamps_move_;
    std::optional<LampCellsView> lamps;
    if (has_lamp_lists(job)) lamps = lamp_cells_.view(eye, lamp_cell_edge(job.camera));
    trace({job.scene, job.tracer, movers, camera, cache, lamps, seed}, pass, job.slices);
    if (lamps) {
      lamp_cells_.ask(lamp_requests_);
      rays_ += lamp_cells_.update(job.scene, job.tracer, seed, budget(interactive::kOldLampCells),
                                  watch);
    }
    cache_.ask(requests_);
    if (first && cache_.size() > interactive::kMaxFirstCells &&
        coarse_ < interactive::kMaxEdgeFactor) {
      coarse_ *= 2;
      cache_ = {};
      continue;
    }
    again = first;  // a first frame is traced twice: its rays saw no cache
    rays_ += cache_.update({job.scene, job.tracer, eye, edge, seed}, first, cells, watch);
    if (first && !watch->stopped()) keep_first_light(key);
    if (requests_.empty()) break;
  }
  look_up(cache_.view(eye, cell_edge(job.camera) * coarse_));
  now_.signals = job.scene.media.volumes.empty() ? kAirSignal : kSignals;
  filter_.accumulate(before_, &now_);
  job.slices->pause();
  filter_.smooth(now_);
  compose();
  job.slices->pause();
  resolve(before_, now_, &filter_.color_gain, past_image_, &image_);
  std::swap(now_, before_);
  std::swap(image_, past_image_);
  ++pictures_;
}

bool InteractiveHistory::load_first_light(uint64_t key) {
  float coarse = 1;
  const bool there = load_light(key, [&](ArchiveReader& in) {
    in(coarse);
    cache_.visit(in);
    lamp_cells_.visit(in);
  });
  if (there) {
    coarse_ = coarse;
  } else {
    cache_ = {};
  }
  return there;
}

void InteractiveHistory::keep_first_light(uint64_t key) {
  if (cache_.size() < kLightWorthKeeping) return;
  keep_light(key, [&](ArchiveWriter& out) {
    out(coarse_);
    cache_.visit(out);
    lamp_cells_.visit(out);
  });
}

void InteractiveHistory::resize(int width, int height) {
  if (width == image_.width && height == image_.height) return;
  const int w = frame_pixels(width), h = frame_pixels(height);
  now_.resize(w, h);
  before_.resize(w, h);
  filter_.resize(w, h);
  image_.resize(width, height);
  past_image_.resize(width, height);
  pictures_ = 0;
  coarse_ = 1;
}

RenderStats InteractiveHistory::render(const Job& job) {
  Film* const film = job.film;
  rays_ = 0;
  resize(film->width, film->height);
  const CameraView32 camera =
      scaled(job.camera, static_cast<float>(now_.width) / static_cast<float>(film->width),
             static_cast<float>(now_.height) / static_cast<float>(film->height));
  const bool first = pictures_ == 0;
  lamps_move_ = find_moving_lamps(job.scene);
  lamp_cells_.follow(job.scene);
  const uint32_t passes = first ? interactive::kFirstPictures : 1;
  RenderWatch watch(job.settings.progress,
                    first ? IrradianceCache::kFirstRounds + interactive::kFirstPictures : 1,
                    *job.slices);
  for (uint32_t pass = 0; pass < passes && !watch.stopped(); ++pass)
    add_frame(job, camera, pass, &watch);
  parallel_for("interactive film", film->height, [&](int64_t y) {
    for (int x = 0; x < film->width; ++x) {
      film->radiance[static_cast<size_t>(y) * film->width + x] =
          past_image_.color.get(x, static_cast<int>(y));
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

#include "render/cpu/cpu_stages.h"

#include <algorithm>
#include <numeric>

#include "render/cpu/path/exact_channels.h"
#include "render/cpu/path/watch.h"

namespace gloam {
namespace {

/// Tile `i` of the order in which tiles are rendered: far apart, so that those which are done tell
/// how long the others will take. A bijection: the step has no divisor in common with `tiles`.
int64_t scattered(int64_t i, int64_t tiles) {
  int64_t step = static_cast<int64_t>(0.6180339887 * static_cast<double>(tiles)) | 1;
  while (std::gcd(step, tiles) != 1) ++step;
  return i * step % tiles;
}

template <class F>
void for_tiles(const Job& job, int64_t count, const F& f) {
  job.slices->run("render tiles", count, [&](int64_t i) {
    const FlushDenormals flush;
    f(i);
  });
}

}  // namespace

int64_t CpuStages::begin(const Film& film) {
  columns_ = (film.width + kTile - 1) / kTile;
  tiles_.assign(static_cast<size_t>(columns_) * ((film.height + kTile - 1) / kTile), {});
  return static_cast<int64_t>(tiles_.size());
}

RenderStats CpuStages::render(Job& job) {
  const RenderSettings& settings = job.settings;
  const bool adaptive = settings.error > 0;
  const int64_t count = begin(*job.film);
  RenderWatch watch(settings.progress, count, *job.slices);
  job.watch = &watch;
  const AdaptivePlan plan = adaptive ? look(job) : AdaptivePlan();
  for_tiles(job, count, [&](int64_t i) {
    if (watch.stopped()) return;
    const int64_t tile = settings.progress ? scattered(i, count) : i;
    render_tile(job, tile, plan);
    watch.tile_done();
  });
  RenderStats total;
  for (const RenderStats& tile : tiles_) {
    total.paths += tile.paths;
    total.rays += tile.rays;
    total.unreached += tile.unreached;
  }
  total.finished = !watch.stopped();
  job.watch = nullptr;
  return total;
}

void CpuStages::render_exact_channels(const Job& job) {
  for_tiles(job, begin(*job.film),
            [&](int64_t tile) { render_channels(job, x_of(tile), y_of(tile), nullptr); });
}

AdaptivePlan CpuStages::look(const Job& job) {
  std::vector<double> deviations(tiles_.size());
  std::vector<int> pixels(tiles_.size());
  for_tiles(job, static_cast<int64_t>(tiles_.size()), [&](int64_t tile) {
    const auto i = static_cast<size_t>(tile);
    deviations[i] = look_adaptive(job, x_of(tile), y_of(tile), &tiles_[i]);
    pixels[i] = std::min(kTile, job.film->width - x_of(tile)) *
                std::min(kTile, job.film->height - y_of(tile));
  });
  return plan_adaptive(job.settings, deviations, pixels);
}

void CpuStages::render_tile(const Job& job, int64_t tile, const AdaptivePlan& plan) {
  const RenderSettings& settings = job.settings;
  RenderStats* stats = &tiles_[static_cast<size_t>(tile)];
  const int x0 = x_of(tile), y0 = y_of(tile);
  if (settings.error > 0) {
    render_adaptive(job, x0, y0, plan, stats);
    if (settings.exact_channels) stats->rays += render_channels(job, x0, y0, nullptr);
    return;
  }
  CenterHits centers;
  if (settings.spp > 0) {
    Tile pixels(job, x0, y0);
    if (settings.tier == RenderTier::kDirect) {
      pixels.render_direct(&centers);
    } else {
      pixels.render_path({settings.seed, settings.first_sample, settings.spp});
    }
    pixels.store_means(stats);
  }
  if (settings.exact_channels) {
    stats->rays += render_channels(job, x0, y0, job.centered ? &centers : nullptr);
  }
}

}  // namespace gloam

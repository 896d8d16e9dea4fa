// A tile's paths in lanes, or in waves of single rays traced in packets.

#include "render/cpu/path/tile.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "render/cpu/path/wave.h"
#include "render/kernel/path/direct.h"

namespace gloam {
namespace {

/// Samples of a pixel that run side by side in lanes, at most: their rays keep together.
constexpr int kMaxSamplesInLanes = 4;
/// Lanes without a path from which on new ones are begun: fewer do not pay for it.
constexpr int kRefillThreshold = kLaneCount / 8;

}  // namespace

template <class State, class Start, class Advance, class Finish>
void Tile::sample(Wave<State>* wave, int index, const Start& start, const Advance& advance,
                  const Finish& finish) {
  const RenderSettings& settings = job_.settings;
  wave->count = count_;
  for (int i = 0; i < count_; ++i) {
    Sampler sampler = Sampler::make(
        settings.seed, settings.frame, static_cast<uint32_t>(x_[i]), static_cast<uint32_t>(y_[i]),
        static_cast<uint32_t>(settings.first_sample + index), job_.log2_samples);
    Vec2f offset, lens;
    float time = 0;
    if (!job_.centered) {
      offset = sample_pixel_filter(sampler.next_2d());
      if (job_.has_motion) time = job_.camera.time_of(y_[i], sampler.next_1d());
      if (job_.camera.aperture.radius > 0) lens = sampler.next_2d();
    }
    RayCone cone;
    const Ray ray = pixel_ray(i, offset, time, &cone, &lens);
    sees_[i] = sees(ray);
    start(&wave->states[i], ray, cone, sampler);
  }
  wave->run(job_.scene, job_.tracer, advance);
  for (int i = 0; i < count_; ++i) {
    mean_[i].add(sees_[i] ? wave->states[i].result : PathResult{});
    rays_ += wave->states[i].result.rays;
    finish(i, wave->states[i]);
  }
}

void Tile::render_path(const SampleRange& range) {
  std::vector<PathResult> results(
      static_cast<size_t>(count_ * std::min(kMaxSamplesInLanes, range.count)));
  for (int done = 0; done < range.count && job_.may_continue(); done += kMaxSamplesInLanes) {
    const int together = std::min(kMaxSamplesInLanes, range.count - done);
    trace_paths({range.seed, range.first + done, together}, results.data());
    for (int path = 0; path < count_ * together; ++path) {
      const PathResult& result = results[static_cast<size_t>(path)];
      mean_[path / together].add(result);
      rays_ += result.rays;
    }
  }
}

void Tile::render_direct(CenterHits* centers) {
  const auto wave = std::make_unique<Wave<DirectState>>();
  for (int index = 0; index < job_.settings.spp && job_.may_continue(); ++index) {
    sample(
        wave.get(), index, direct_start,
        [this](DirectState* state, bool found, const RayHit& hit) {
          return direct_advance(job_.scene, state, found, hit,
                                [](const Ray&, const Surface&, const RayHit&) {});
        },
        [&](int i, const DirectState& state) {
          const int at = index_[i];
          centers->known[at] =
              job_.centered && (state.layers == 0 || (state.layers == 1 && state.has_first));
          centers->found[at] = state.has_first;
          centers->hits[at] = state.first;
        });
  }
}

void Tile::store_means(RenderStats* stats) const {
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

/// Traces all samples of `range` of each pixel: lanes whose path has ended begin another one.
void Tile::trace_paths(const SampleRange& range, PathResult* results) {
  using F = FloatLanes;
  const int count = count_ * range.count;
  paths::State<F> path;
  MaskLanes active = false;
  int path_of[kLaneCount] = {}, begun = 0;
  while (begun < count || any(active)) {
    const bool coherent = !any(active);
    const MaskLanes idle = !active;
    if (begun < count && __builtin_popcount(bits_of(idle)) >= kRefillThreshold) {
      MaskLanes starting = false;
      each_lane(idle, [&](int i) {
        if (begun == count) return;
        path_of[i] = begun++;
        set_lane(&starting, i, true);
      });
      MaskLanes seeing = starting;
      path.start(camera_sample(range, path_of, &seeing), starting);
      active = active | seeing;
      each_lane(starting & !seeing, [&](int i) { results[path_of[i]] = {}; });
    }
    const MaskLanes before = active;
    active = paths::advance(job_.scene, job_.tracer, job_.path, coherent, &path, active);
    each_lane(before & !active, [&](int i) {
      const PathResultOf<F>& r = path.result;
      results[path_of[i]] = {lane(r.radiance, i), lane(r.albedo, i), lane(r.normal, i),
                             lane(r.rays, i)};
    });
  }
}

/// The camera's rays for the paths path_of[i] of the lanes in `seeing`, when each pixel has all
/// samples of `range`; takes those lanes out whose ray sees nothing.
paths::CameraSampleOf<FloatLanes> Tile::camera_sample(const SampleRange& range, const int* path_of,
                                                      MaskLanes* seeing) const {
  paths::CameraSampleOf<FloatLanes> out;
  UintLanes x, y, sample;
  each_lane(*seeing, [&](int i) {
    const int pixel = path_of[i] / range.count;
    set_lane(&x, i, static_cast<uint32_t>(x_[pixel]));
    set_lane(&y, i, static_cast<uint32_t>(y_[pixel]));
    set_lane(&sample, i, static_cast<uint32_t>(range.first + path_of[i] % range.count));
  });
  out.sampler =
      SamplerOf<FloatLanes>::make(range.seed, job_.settings.frame, x, y, sample, job_.log2_samples);
  const Vec2Of<FloatLanes> offset = sample_pixel_filter(out.sampler.next_2d());
  FloatLanes time = 0.0f;
  if (job_.has_motion) {
    const FloatLanes fraction = out.sampler.next_1d();
    each_lane(*seeing, [&](int i) {
      set_lane(&time, i, job_.camera.time_of(static_cast<int>(lane(y, i)), lane(fraction, i)));
    });
  }
  Vec2Of<FloatLanes> lens;
  if (job_.camera.aperture.radius > 0) lens = out.sampler.next_2d();
  RayConeOf<FloatLanes> cone;
  out.ray = camera_rays(job_.camera, to_float(x) + 0.5f + offset.x, to_float(y) + 0.5f + offset.y,
                        time, &cone, &lens);
  out.cone_width = cone.width;
  out.cone_spread = cone.spread;
  *seeing = *seeing & (out.ray.tmax > 0.0f);
  return out;
}

}  // namespace gloam

// A tile's paths in lanes, or in waves of single rays traced in packets.

#include "render/cpu/tile.h"

#include <algorithm>
#include <memory>

#include "render/cpu/wave.h"
#include "render/kernel/direct.h"

namespace gloam {
namespace {

/// Samples of a pixel that run side by side in lanes, at most: their rays keep together.
constexpr int kTogether = 4;

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
  for (int done = 0; done < range.count; done += kTogether) {
    const int together = std::min(kTogether, range.count - done);
    for (int first = 0; first < count_ * together; first += kLaneCount) {
      sample_lanes(first, {range.seed, range.first + done, together});
    }
  }
}

void Tile::render_direct(CenterHits* centers) {
  const auto wave = std::make_unique<Wave<DirectState>>();
  for (int index = 0; index < job_.settings.spp; ++index) {
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

/// Paths from the one on that is `first` when each pixel has all samples of `range`.
void Tile::sample_lanes(int first, const SampleRange& range) {
  using F = FloatLanes;
  const int together = range.count;
  const int used = std::min(kLaneCount, count_ * together - first);
  MaskLanes active = false;
  UintLanes x, y, sample;
  int pixel[kLaneCount];
  for (int i = 0; i < kLaneCount; ++i) {
    const int path = first + std::min(i, used - 1);
    pixel[i] = path / together;
    set_lane(&active, i, i < used);
    set_lane(&x, i, static_cast<uint32_t>(x_[pixel[i]]));
    set_lane(&y, i, static_cast<uint32_t>(y_[pixel[i]]));
    set_lane(&sample, i, static_cast<uint32_t>(range.first + path % together));
  }
  auto sampler =
      SamplerOf<F>::make(range.seed, job_.settings.frame, x, y, sample, job_.log2_samples);
  const Vec2Of<F> filter = sampler.next_2d();
  const F time = job_.has_motion ? sampler.next_1d() : F(0.0f);
  Vec2Of<F> lens;
  if (job_.camera.aperture.radius > 0) lens = sampler.next_2d();
  RayOf<F> ray;
  F width, spread;
  for (int i = 0; i < kLaneCount; ++i) {
    RayCone cone;
    const Vec2f lens_point = lane(lens, i);
    const float when = job_.has_motion ? job_.camera.time_of(y_[pixel[i]], lane(time, i)) : 0.0f;
    const Ray one =
        pixel_ray(pixel[i], sample_pixel_filter(lane(filter, i)), when, &cone, &lens_point);
    if (!sees(one)) set_lane(&active, i, false);
    set_lane(&ray.time, i, one.time);
    set_lane(&ray.o, i, one.o);
    set_lane(&ray.d, i, one.d);
    set_lane(&width, i, cone.width);
    set_lane(&spread, i, cone.spread);
  }
  const PathResultOf<F> result =
      trace_path(job_.scene, job_.tracer, ray, width, spread, job_.path, sampler, active);
  for (int i = 0; i < used; ++i) {
    mean_[pixel[i]].add({lane(result.radiance, i), lane(result.albedo, i), lane(result.normal, i),
                         lane(result.rays, i)});
    rays_ += lane(result.rays, i);
  }
}

}  // namespace gloam

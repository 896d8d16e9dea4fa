#include "render/cpu/particles/particle_streaks.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/cpu/particles/streak_finder.h"

namespace gloam {
namespace {

constexpr float kPerCell = 6;  // particles, in the mean

/// Coverage of each pixel by the particles of a set, and the light that they bring.
struct Layer {
  std::vector<float> cover;
  std::vector<Vec3f> light;
};

void draw_rows(const std::vector<Streak>& streaks, const Film& film, int first, int last,
               Layer* layer) {
  for (const Streak& s : streaks) {
    const float reach = s.radius + 0.5f;
    const int y0 = std::max(first, static_cast<int>(std::floor(min(s.from.y, s.to.y) - reach)));
    const int y1 = std::min(last, static_cast<int>(std::ceil(max(s.from.y, s.to.y) + reach)) + 1);
    const Vec2f way = s.to - s.from;
    const float way2 = way.x * way.x + way.y * way.y;
    const float most = min(2 * s.radius, 1.0f);
    for (int y = y0; y < y1; ++y) {
      const float py = static_cast<float>(y) + 0.5f;
      // Part of the streak that comes near this row.
      float xa = min(s.from.x, s.to.x), xb = max(s.from.x, s.to.x);
      if (std::fabs(way.y) > 1e-6f) {
        const auto x_at = [&](float row) {
          return s.from.x + way.x * clamp((row - s.from.y) / way.y, 0.0f, 1.0f);
        };
        const float c = x_at(py - reach), d = x_at(py + reach);
        xa = min(c, d), xb = max(c, d);
      }
      const int x0 = std::max(0, static_cast<int>(std::floor(xa - reach)));
      const int x1 = std::min(film.width, static_cast<int>(std::ceil(xb + reach)) + 1);
      for (int x = x0; x < x1; ++x) {
        const Vec2f at = Vec2f{static_cast<float>(x) + 0.5f, py} - s.from;
        const float t = way2 > 0 ? clamp((at.x * way.x + at.y * way.y) / way2, 0.0f, 1.0f) : 0.0f;
        const float off = way_length(at - way * t);
        float alpha = s.cover * clamp(0.5f + s.radius - off, 0.0f, most);
        if (s.soft && s.radius > 1) alpha *= max(1.5f * (1 - sqr(off / reach)), 0.0f);
        const size_t i =
            static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x);
        if (!(alpha > 0) || film.distance[i] < s.distance) continue;
        layer->cover[i] += alpha;
        layer->light[i] += s.light * alpha;
      }
    }
  }
}

/// Mean fraction of the pixel's ray that the rendered particles cover, of which the medium has
/// dimmed it.
float mean_cover(const ParticleView& view, const ParticleSet& set, const StreakFinder& finder,
                 Vec3f eye, Vec3f d, float distance) {
  float sum = 0, farthest = 0;
  for (const ParticleClass& kind : set.classes) {
    const float far = min(finder.reach(kind.diameter), distance);
    if (far <= kNearestParticle) continue;
    sum += kind.number * kPi / 4 * kind.diameter * kind.diameter * (far - kNearestParticle);
    farthest = max(farthest, far);
  }
  if (view.weather.shelter->nx == 0 || sum == 0) return sum;
  constexpr int kShelterSamples = 4;
  float open = 0;
  for (int i = 0; i < kShelterSamples; ++i) {
    const float t = farthest * (static_cast<float>(i) + 0.5f) / kShelterSamples;
    open += view.weather.shelter->view().open_above(eye + d * t, 0) / kShelterSamples;
  }
  return sum * open;
}

}  // namespace

void draw_particles(const ParticleView& view, const Film& film, std::vector<Vec3f>* radiance) {
  const Vec3f eye = view.camera.pose.X_WC_open.p;
  const AmbientCube around = light_around(view.scene, view.tracer, eye);
  const BlurredPicture blurred(*radiance, film.width, film.height, view.camera.fx);
  const StreakFinder finder(view, film, around, blurred);
  uint32_t row = 0;
  for (const ParticleSet& set : view.weather.particles) {
    std::vector<Streak> streaks;
    for (const ParticleClass& kind : set.classes) {
      const float cell = clamp(std::cbrt(kPerCell / max(kind.number, 1e-6f)), 0.05f, 4.0f);
      finder.find({set, kind, row++, cell}, &streaks);
    }
    std::vector<Streak> splashes;
    for (uint32_t k = 0; k < set.classes.size(); ++k) finder.find_splashes(set, k, &splashes);
    if (set.kind == ParticleKind::kDrop) finder.find_drips(set.seed, &splashes);
    if (streaks.empty() && splashes.empty()) continue;
    Vec3f mean_light;
    float weight = 0;
    for (const Streak& s : streaks) {
      const float w = s.cover * s.radius * (2 * way_length(s.to - s.from) + kPi * s.radius);
      mean_light += s.light * w;
      weight += w;
    }
    if (weight > 0) mean_light *= 1 / weight;
    Layer layer{std::vector<float>(film.pixel_count()), std::vector<Vec3f>(film.pixel_count())};
    constexpr int kBand = 16;  // rows
    parallel_for("draw particles", (film.height + kBand - 1) / kBand, [&](int64_t band) {
      const int first = static_cast<int>(band) * kBand;
      const int last = std::min(first + kBand, film.height);
      draw_rows(streaks, film, first, last, &layer);
      draw_rows(splashes, film, first, last, &layer);
      for (int y = first; y < last; ++y) {
        for (int x = 0; x < film.width; ++x) {
          const size_t i =
              static_cast<size_t>(y) * static_cast<size_t>(film.width) + static_cast<size_t>(x);
          RayCone cone;
          const Ray ray = camera_ray(view.camera, static_cast<float>(x) + 0.5f,
                                     static_cast<float>(y) + 0.5f, 0, &cone);
          if (!sees(ray)) continue;
          const float scale = layer.cover[i] > 1 ? 1 / layer.cover[i] : 1.0f;
          const float far = min(film.distance[i], kFarthestParticle);
          const float mean = weight > 0 ? mean_cover(view, set, finder, eye, ray.d, far) : 0;
          Vec3f& light = (*radiance)[i];
          const Vec3f before = light;
          light += layer.light[i] * scale - before * min(layer.cover[i], 1.0f) -
                   (mean_light - before) * (1 - std::exp(-mean));
          light = {max(light.x, 0.0f), max(light.y, 0.0f), max(light.z, 0.0f)};
        }
      }
    });
  }
}

}  // namespace gloam

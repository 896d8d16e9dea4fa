#include "render/cpu/particle_streaks.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "render/cpu/particle_light.h"
#include "render/kernel/fast.h"
#include "world/rain_splash.h"

namespace gloam {
namespace {

constexpr float kNearest = 0.1f;         // [m] a lens has a hood
constexpr float kFarthest = 30.0f;       // [m]
constexpr float kFarthestSplash = 6.0f;  // [m]
constexpr float kLeastWidth = 0.12f;     // [px] of a particle that is drawn
constexpr float kPerCell = 6;            // particles, in the mean
// Mean cosines of what is scattered without diffraction: of water by Mie theory for large spheres.
constexpr float kDropG = 0.885f, kFlakeG = 0.3f;

float way_length(Vec2f v) { return std::sqrt(v.x * v.x + v.y * v.y); }

/// Way of one particle over the picture while the shutter is open.
struct Streak {
  Vec2f from, to;      ///< [px]
  float radius = 0;    ///< [px]
  float share = 1;     ///< of the exposure for which it covers a point of its way
  float distance = 0;  ///< [m]
  Vec3f light;         ///< that it sends to the camera [cd/m²]
  bool soft = false;   ///< thinner towards its edge
};

/// Projects points at times of the shutter.
class Projector {
 public:
  explicit Projector(const CameraView32& camera) : camera_(camera) {
    X_CW_ = inverse(camera.pose.X_WC_open);
  }
  bool project(Vec3f p_W, float time, Vec2f* uv) const {
    if (!camera_.pose.keys.empty())
      return gloam::project(camera_, camera_pose_at(camera_.pose, time), p_W, uv);
    const Vec3f p = transform_point(X_CW_, p_W);
    if (!camera_.orthographic && !camera_.is_pinhole()) {
      float x, y;
      if (!lens_project(camera_.lens, p.x, -p.y, -p.z, &x, &y)) return false;
      *uv = {camera_.cx + camera_.fx * x, camera_.cy + camera_.fy * y};
      return true;
    }
    if (!camera_.orthographic && p.z > -1e-3f) return false;
    const float s = camera_.orthographic ? 1.0f : -1.0f / p.z;
    *uv = {camera_.cx + camera_.fx * p.x * s, camera_.cy - camera_.fy * p.y * s};
    return true;
  }

 private:
  const CameraView32& camera_;
  Affine3f X_CW_;
};

/// How many of Poisson's law with this mean, of one uniform number.
int poisson(float mean, float u) {
  float p = std::exp(-mean), sum = p;
  int n = 0;
  while (u > sum && n < 64) {
    p *= mean / static_cast<float>(++n);
    sum += p;
  }
  return n;
}

/// The particles of one class in their own frame, which falls with them: cells of a lattice, each
/// with draws of its own.
struct Lattice {
  const ParticleSet& set;
  const ParticleClass& kind;
  uint32_t row = 0;
  float cell = 1;  ///< [m]

  /// Where the frame's origin is.
  void origin(double time, double p[3]) const {
    p[0] = static_cast<double>(set.wind.x) * time;
    p[1] = static_cast<double>(set.wind.y) * time;
    p[2] = -static_cast<double>(kind.fall_speed) * time;
  }
  Vec3f velocity() const { return set.wind - Vec3f{0, 0, kind.fall_speed}; }
};

struct Particle {
  ParticleKind kind;
  float diameter;  ///< [m]
  Vec3f velocity;  ///< [m/s]
};

class StreakFinder {
 public:
  StreakFinder(const ParticleView& view, const Film& film, const AmbientCube& around,
               const BlurredPicture& blurred)
      : view_(view), film_(film), around_(around), blurred_(blurred), projector_(view.camera) {
    const CameraView32& camera = view.camera;
    eye_ = camera.pose.X_WC_open.p;
    axis_ = -camera.pose.X_WC_open.z;
    const float x = max(camera.cx, static_cast<float>(film.width) - camera.cx) / camera.fx;
    const float y = max(camera.cy, static_cast<float>(film.height) - camera.cy) / camera.fy;
    half_angle_ = camera.is_pinhole() && !camera.orthographic
                      ? std::atan(std::sqrt(x * x + y * y)) + 0.05f
                      : kPi;
  }

  /// Beyond it a particle is too small to be drawn [m].
  float reach(const ParticleClass& kind) const {
    return min(kind.diameter * view_.camera.fx / kLeastWidth, kFarthest);
  }

  /// Droplets that fly up where drops of class `row` have landed.
  void find_splashes(const ParticleSet& set, uint32_t row, std::vector<Streak>* out) const {
    const ParticleClass& kind = set.classes[row];
    const float far = min(kDropletSize * reach(kind), kFarthestSplash);
    if (set.kind != ParticleKind::kDrop || far <= 2 * kNearest || !splashes(kind)) return;
    const double exposure = view_.seconds * static_cast<double>(view_.camera.shutter.length);
    const double now = view_.opens + exposure / 2;
    const auto cell_of = [](float x) { return static_cast<int64_t>(std::floor(x / kSplashCell)); };
    const int64_t low = cell_of(eye_.y - far), rows = cell_of(eye_.y + far) - low + 1;
    std::vector<std::vector<Streak>> found(static_cast<size_t>(rows));
    parallel_for("splashes", rows, [&](int64_t line) {
      std::vector<Splash> landed;
      for (int64_t i = cell_of(eye_.x - far); i <= cell_of(eye_.x + far); ++i)
        gloam::find_splashes(set, row, i, low + line, now - splash_life(kind), now, &landed);
      for (const Splash& splash : landed)
        add_splash(kind, splash, now, far, &found[static_cast<size_t>(line)]);
    });
    for (const auto& part : found) out->insert(out->end(), part.begin(), part.end());
  }

  void find(const Lattice& lattice, std::vector<Streak>* out) const {
    const float far = reach(lattice.kind);
    if (far <= 2 * kNearest) return;
    double origin[3];
    const double exposure = view_.seconds * static_cast<double>(view_.camera.shutter.length);
    lattice.origin(view_.opens + exposure / 2, origin);
    const double edge = static_cast<double>(lattice.cell);
    int64_t low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      const double at = static_cast<double>(eye_[a]) - origin[a];
      low[a] = static_cast<int64_t>(std::floor((at - static_cast<double>(far)) / edge));
      high[a] = static_cast<int64_t>(std::floor((at + static_cast<double>(far)) / edge));
    }
    const int64_t layers = high[2] - low[2] + 1;
    std::vector<std::vector<Streak>> found(static_cast<size_t>(layers));
    parallel_for("particles", layers, [&](int64_t layer) {
      const int64_t k = low[2] + layer;
      for (int64_t j = low[1]; j <= high[1]; ++j) {
        for (int64_t i = low[0]; i <= high[0]; ++i)
          look_into(lattice, {i, j, k}, origin, far, &found[static_cast<size_t>(layer)]);
      }
    });
    for (const auto& part : found) out->insert(out->end(), part.begin(), part.end());
  }

 private:
  struct Cell {
    int64_t i, j, k;
  };

  void look_into(const Lattice& lattice, Cell at, const double origin[3], float far,
                 std::vector<Streak>* out) const {
    const double edge = static_cast<double>(lattice.cell);
    const auto to_world = [&](double x, double y, double z) {
      return Vec3f{static_cast<float>((static_cast<double>(at.i) + x) * edge + origin[0]),
                   static_cast<float>((static_cast<double>(at.j) + y) * edge + origin[1]),
                   static_cast<float>((static_cast<double>(at.k) + z) * edge + origin[2])};
    };
    const Vec3f middle = to_world(0.5, 0.5, 0.5) - eye_;
    const float d = length(middle), radius = 0.87f * lattice.cell;
    if (d > far + radius) return;
    if (d > radius && half_angle_ < 0.5f * kPi) {
      const float angle = std::acos(clamp(dot(middle, axis_) / d, -1.0f, 1.0f));
      if (angle > half_angle_ + std::asin(min(radius / d, 1.0f))) return;
    }
    const auto bits = [](int64_t x) { return static_cast<uint64_t>(x) & 0x1FFFFF; };
    const uint64_t key = bits(at.i) | bits(at.j) << 21 | bits(at.k) << 42;
    const RandomStream random{lattice.set.seed, stream_id("particles") + lattice.row};
    const Philox4 first = random.draw(key, 0);
    const float mean = lattice.kind.number * lattice.cell * lattice.cell * lattice.cell;
    const int count = poisson(mean, uniform_float(first.v[0]));
    for (int n = 0; n < count; ++n) {
      const Philox4 place = random.draw(key, static_cast<uint32_t>(n + 1));
      const Vec3f p = to_world(static_cast<double>(uniform_float(place.v[0])),
                               static_cast<double>(uniform_float(place.v[1])),
                               static_cast<double>(uniform_float(place.v[2])));
      add({lattice.set.kind, lattice.kind.diameter, lattice.velocity()}, p, far, place, out);
    }
  }

  void add_splash(const ParticleClass& kind, const Splash& splash, double now, float far,
                  std::vector<Streak>* out) const {
    Ray down;  // onto what lies highest there
    down.o = {splash.at.x, splash.at.y, eye_.z + kFarthest};
    down.d = {0, 0, -1};
    const Vec3f to{splash.at.x - eye_.x, splash.at.y - eye_.y, 0};
    RayHit hit;
    if (dot(to, to) > far * far || !view_.tracer.trace(down, false, &hit)) return;
    const Vec3f ground = down.o + down.d * hit.t;
    if (!(view_.weather.shelter->view().open_above(ground, 0.05f) > 0.5f)) return;
    constexpr float kGravity = 9.81f;
    const auto t = static_cast<float>(now - splash.time);
    for (int n = 0; n < kSplashDroplets; ++n) {
      const SplashDroplet d = splash_droplet(kind, splash, n);
      const Vec3f p = d.from + d.velocity * t - Vec3f{0, 0, 0.5f * kGravity * t * t};
      if (p.z > 0)
        add({ParticleKind::kDrop, d.diameter, d.velocity - Vec3f{0, 0, kGravity * t}}, ground + p,
            far, splash.bits, out);
    }
  }

  /// `p`: where the particle is in the middle of the exposure.
  void add(const Particle& particle, Vec3f p, float far, const Philox4& bits,
           std::vector<Streak>* out) const {
    const CameraView32& camera = view_.camera;
    Streak s;
    s.distance = length(p - eye_);
    if (s.distance < kNearest || s.distance > far) return;
    Vec2f uv;
    if (!projector_.project(p, 0, &uv)) return;
    // Its row's own exposure.
    const float row = clamp(uv.y, 0.0f, static_cast<float>(film_.height)) * camera.shutter.row;
    const auto seconds = static_cast<float>(view_.seconds);
    const float half = 0.5f * camera.shutter.length;
    const Vec3f v = particle.velocity * seconds;
    const Vec3f a = p + v * (row - half), b = p + v * (row + half);
    if (!projector_.project(a, row, &s.from) || !projector_.project(b, row + 2 * half, &s.to))
      return;
    s.radius = 0.5f * particle.diameter * camera.fx / s.distance;
    float blur = 0;
    if (camera.has_aperture())
      blur = camera.aperture.radius * camera.fx *
             std::fabs(1 / s.distance - 1 / camera.aperture.focus);
    const float way = way_length(s.to - s.from), wide = s.radius + blur;
    const float margin = wide + 1;
    if (max(s.from.x, s.to.x) < -margin || max(s.from.y, s.to.y) < -margin ||
        min(s.from.x, s.to.x) > static_cast<float>(film_.width) + margin ||
        min(s.from.y, s.to.y) > static_cast<float>(film_.height) + margin)
      return;
    if (!(view_.weather.shelter->view().open_above(p, 0) > 0.5f)) return;
    // A disc of the radius r covers its way of length l and width 2 r for as long as makes pi r².
    s.share = kPi * s.radius * s.radius / (2 * wide * way + kPi * wide * wide);
    s.radius = wide;
    s.soft = particle.kind == ParticleKind::kFlake;
    s.light = light_of(particle.kind, p, uv, bits);
    out->push_back(s);
  }

  Vec3f light_of(ParticleKind kind, Vec3f p, Vec2f uv, const Philox4& bits) const {
    const Vec3f d = normalize(p - eye_);
    const bool drop = kind == ParticleKind::kDrop;
    Vec3f light;
    if (drop) {
      // Half of what a sphere of water sends on comes from within some twenty degrees behind it.
      light = blurred_.at(uv) * 0.5f + around_.on(d) * 0.5f;
    } else {
      light = around_.on(d) * 0.6f + around_.on(-d) * 0.4f;
    }
    if (view_.scene.lights.size == 0) return light;
    const float g = drop ? kDropG : kFlakeG;
    MediumPoint point;
    point.scattering = {1, 1, 1};
    point.g_scattering = {g, g, g};
    Ray ray;
    ray.o = eye_;
    ray.d = d;
    WalkRandom random({uniform_float(bits.v[3]), uniform_float(bits.v[3] * 0x9E3779B9u)});
    uint32_t rays = 0;
    return light + fasts::scattered_light(view_.scene, view_.tracer, ray, point, p, &random, &rays);
  }

  const ParticleView& view_;
  const Film& film_;
  const AmbientCube& around_;
  const BlurredPicture& blurred_;
  const Projector projector_;
  Vec3f eye_, axis_;
  float half_angle_ = 0;
};

/// What the particles of a set cover of each pixel, and the light they bring.
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
      // Only the part of the way that comes near this row.
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
        float alpha = s.share * clamp(0.5f + s.radius - off, 0.0f, most);
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

/// Mean share of the pixel's ray that the drawn ones cover, of which the medium has dimmed it.
float mean_cover(const ParticleView& view, const ParticleSet& set, const StreakFinder& finder,
                 Vec3f eye, Vec3f d, float distance) {
  float sum = 0, farthest = 0;
  for (const ParticleClass& kind : set.classes) {
    const float far = min(finder.reach(kind), distance);
    if (far <= kNearest) continue;
    sum += kind.number * kPi / 4 * kind.diameter * kind.diameter * (far - kNearest);
    farthest = max(farthest, far);
  }
  if (view.weather.shelter->nx == 0 || sum == 0) return sum;
  constexpr int kLooks = 4;
  float open = 0;
  for (int i = 0; i < kLooks; ++i) {
    const float t = farthest * (static_cast<float>(i) + 0.5f) / kLooks;
    open += view.weather.shelter->view().open_above(eye + d * t, 0) / kLooks;
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
    if (streaks.empty()) continue;
    std::vector<Streak> splashes;
    for (uint32_t k = 0; k < set.classes.size(); ++k) finder.find_splashes(set, k, &splashes);
    Vec3f mean_light;
    float weight = 0;
    for (const Streak& s : streaks) {
      const float w = s.share * s.radius * (2 * way_length(s.to - s.from) + kPi * s.radius);
      mean_light += s.light * w;
      weight += w;
    }
    mean_light *= 1 / weight;
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
          const float mean =
              mean_cover(view, set, finder, eye, ray.d, min(film.distance[i], kFarthest));
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

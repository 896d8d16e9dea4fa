#include "render/cpu/particles/streak_finder.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/kernel/interactive/air.h"

namespace gloam {
namespace {

constexpr float kLeastWidth = 0.12f;  // [px] of a particle that is drawn
// Mean cosines of what is scattered without diffraction: of water by Mie theory for large spheres.
constexpr float kDropG = 0.885f, kFlakeG = 0.3f;

/// Sample of Poisson's law with this mean, by one uniform number.
int poisson(float mean, float u) {
  float p = std::exp(-mean), sum = p;
  int n = 0;
  while (u > sum && n < 64) {
    p *= mean / static_cast<float>(++n);
    sum += p;
  }
  return n;
}

}  // namespace

StreakFinder::StreakFinder(const ParticleView& view, const Film& film, const AmbientCube& around,
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

float StreakFinder::reach(float diameter) const {
  return min(diameter * view_.camera.fx / kLeastWidth, kFarthestParticle);
}

void StreakFinder::find(const Lattice& lattice, std::vector<Streak>* out) const {
  const float far = reach(lattice.kind.diameter);
  if (far <= 2 * kNearestParticle) return;
  double origin[3];
  lattice.origin(middle(), origin);
  const Vec3f velocity = lattice.velocity(middle());
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
        look_into(lattice, {i, j, k}, origin, velocity, far, &found[static_cast<size_t>(layer)]);
    }
  });
  for (const auto& part : found) out->insert(out->end(), part.begin(), part.end());
}

void StreakFinder::look_into(const Lattice& lattice, Cell at, const double origin[3],
                             Vec3f velocity, float far, std::vector<Streak>* out) const {
  const double edge = static_cast<double>(lattice.cell);
  const auto to_world = [&](double x, double y, double z) {
    return Vec3f{static_cast<float>((static_cast<double>(at.i) + x) * edge + origin[0]),
                 static_cast<float>((static_cast<double>(at.j) + y) * edge + origin[1]),
                 static_cast<float>((static_cast<double>(at.k) + z) * edge + origin[2])};
  };
  const Vec3f to_middle = to_world(0.5, 0.5, 0.5) - eye_;
  const float d = length(to_middle), radius = 0.87f * lattice.cell;
  if (d > far + radius) return;
  if (d > radius && half_angle_ < 0.5f * kPi) {
    const float angle = std::acos(clamp(dot(to_middle, axis_) / d, -1.0f, 1.0f));
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
    if (!is_open(p, 0)) continue;
    add({lattice.set.kind, lattice.kind.diameter, velocity}, p, far, place, out);
  }
}

void StreakFinder::add(const Particle& particle, Vec3f p, float far, const Philox4& bits,
                       std::vector<Streak>* out) const {
  const CameraView32& camera = view_.camera;
  Streak s;
  s.distance = length(p - eye_);
  if (s.distance < kNearestParticle || s.distance > far) return;
  Vec2f uv;
  if (!projector_.project(p, 0, &uv)) return;
  // Exposure of the row that the particle is in.
  const float row = clamp(uv.y, 0.0f, static_cast<float>(film_.height)) * camera.shutter.row;
  const auto seconds = static_cast<float>(view_.seconds);
  const float half = 0.5f * camera.shutter.length;
  const Vec3f v = particle.velocity * seconds;
  const Vec3f a = p + v * (row - half), b = p + v * (row + half);
  if (!projector_.project(a, row, &s.from) || !projector_.project(b, row + 2 * half, &s.to)) return;
  s.radius = 0.5f * particle.diameter * camera.fx / s.distance;
  const float disc = kPi * s.radius * s.radius, way = way_length(s.to - s.from);
  s.radius += blur_at(s.distance);
  if (!is_in_picture(s)) return;
  // A disc of the radius r covers its way of length l and width 2 r for as long as makes pi r².
  s.cover = disc / (2 * s.radius * way + kPi * s.radius * s.radius);
  s.soft = particle.kind == ParticleKind::kFlake;
  s.light = light_of(particle.kind, p, uv, bits);
  out->push_back(s);
}

float StreakFinder::blur_at(float distance) const {
  const CameraView32& camera = view_.camera;
  if (!camera.has_aperture()) return 0;
  return camera.aperture.radius * camera.fx * std::fabs(1 / distance - 1 / camera.aperture.focus);
}

bool StreakFinder::is_in_picture(const Streak& s) const {
  const float margin = s.radius + 1;
  return max(s.from.x, s.to.x) >= -margin && max(s.from.y, s.to.y) >= -margin &&
         min(s.from.x, s.to.x) <= static_cast<float>(film_.width) + margin &&
         min(s.from.y, s.to.y) <= static_cast<float>(film_.height) + margin;
}

Vec3f StreakFinder::light_of(ParticleKind kind, Vec3f p, Vec2f uv, const Philox4& bits) const {
  const Vec3f d = normalize(p - eye_);
  const bool drop = kind == ParticleKind::kDrop;
  Vec3f light;
  if (drop) {
    // Spheres of water send on light, half of it from within some twenty degrees behind them.
    light = blurred_.at(uv) * 0.5f + around_.on(d) * 0.5f;
  } else {
    light = around_.on(d) * 0.6f + around_.on(-d) * 0.4f;
  }
  if (view_.scene.lights.size == 0) return light;
  Ray ray;
  ray.o = p;
  ray.d = d;
  const Vec2f u{uniform_float(bits.v[3]), uniform_float(bits.v[3] * 0x9E3779B9u)};
  WalkRandom random(u);
  uint32_t rays = 0;
  return light + interactive::lamps_in_air(view_.scene, view_.tracer, ray, drop ? kDropG : kFlakeG,
                                           u, &random, &rays);
}

}  // namespace gloam

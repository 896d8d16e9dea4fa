#include "world/weather/rain_splash.h"

#include <cmath>

namespace gloam {
namespace {

constexpr double kSlot = 0.05;  // for which splashes are sampled at once [s]
constexpr float kSplashGravity = 9.81f;
// Factors on the drop's speed and radius: within the range of crowns of drops of 2 to 5 mm, a
// hand's breadth at most.
constexpr float kSlowestDroplet = 0.08f, kFastestDroplet = 0.2f;  // speed
constexpr float kCrown = 1.5f;                                    // radius of the crown's rim

float unit_draw(const Philox4& bits, uint32_t salt) {
  return uniform_float(bits.v[2] * 0x9E3779B9u + salt * 0x85EBCA6Bu +
                       (bits.v[3] ^ (salt << 16 | salt)));
}

}  // namespace

bool splashes(const ParticleClass& kind) {
  constexpr double kDensity = 998, kViscosity = 1.0e-3, kTension = 0.073;  // water at 20 °C
  const double d = static_cast<double>(kind.diameter), v = static_cast<double>(kind.fall_speed);
  const double reynolds = kDensity * v * d / kViscosity;
  const double ohnesorge = kViscosity / std::sqrt(kDensity * kTension * d);
  return ohnesorge * std::pow(reynolds, 1.25) > 57.7;
}

SplashDroplet splash_droplet(const ParticleClass& kind, const Splash& splash, int number) {
  const auto n = static_cast<uint32_t>(number);
  const float around =
      6.2831853f * (static_cast<float>(number) + unit_draw(splash.bits, 3 * n)) / kSplashDroplets;
  const float speed = kind.fall_speed * (kSlowestDroplet + (kFastestDroplet - kSlowestDroplet) *
                                                               unit_draw(splash.bits, 3 * n + 1));
  const float up = 0.80f + 0.18f * unit_draw(splash.bits, 3 * n + 2);  // sine: 53 to 79 degrees
  const float out = std::sqrt(1 - up * up);
  const Vec3f side{std::cos(around), std::sin(around), 0};
  return {side * (kCrown * kind.diameter), side * (speed * out) + Vec3f{0, 0, speed * up},
          kDropletSize * kind.diameter};
}

Crown crown_at(const ParticleClass& kind, float t) {
  constexpr float kYarinWeiss = 0.904f;          // (2/3)^(1/4)
  constexpr float kLife = 40, kFlare = 1.2f;     // [D / V]; the rim's radius over the foot's
  constexpr float kRise = 0.065f, kRim = 0.17f;  // factors on the drop's speed, diameter
  const float d = kind.diameter, v = kind.fall_speed, age = t * v / (d * kLife);
  if (!(age > 0 && age < 1)) return {};
  const float radius = kYarinWeiss * std::sqrt(d * v * t);
  const float height = kRise * v * t - 0.5f * kSplashGravity * t * t;
  return {radius, kFlare * radius, max(height, 0.0f), kRim * d, 1 - age};
}

double splash_life(const ParticleClass& kind) {
  return static_cast<double>(2 * kFastestDroplet * kind.fall_speed / kSplashGravity);
}

void find_splashes(const ParticleSet& set, uint32_t row, int64_t i, int64_t j, double from,
                   double to, std::vector<Splash>* out) {
  const ParticleClass& kind = set.classes[row];
  const double mean = static_cast<double>(kind.number) * static_cast<double>(kind.fall_speed) *
                      static_cast<double>(kSplashCell) * static_cast<double>(kSplashCell) * kSlot;
  const RandomStream random{set.seed, stream_id("splashes") + row};
  const auto first = static_cast<int64_t>(std::floor(from / kSlot));
  const auto last = static_cast<int64_t>(std::floor(to / kSlot));
  for (int64_t slot = first; slot <= last; ++slot) {
    const auto bits = [](int64_t x) { return static_cast<uint64_t>(x) & 0x1FFFFF; };
    const uint64_t key = bits(i) | bits(j) << 21 | bits(slot) << 42;
    // Number by Poisson's law, from the times between one splash and the next.
    double at = 0;
    for (uint32_t n = 0;; ++n) {
      const Philox4 draw = random.draw(key, n);
      at -= std::log(1 - static_cast<double>(uniform_float(draw.v[0]))) / mean;
      if (!(at < 1)) break;
      const double time = (static_cast<double>(slot) + at) * kSlot;
      if (time < from || time >= to) continue;
      out->push_back({{(static_cast<float>(i) + uniform_float(draw.v[1])) * kSplashCell,
                       (static_cast<float>(j) + uniform_float(draw.v[2])) * kSplashCell},
                      time,
                      draw});
    }
  }
}

}  // namespace gloam

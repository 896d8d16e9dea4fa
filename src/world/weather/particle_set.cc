#include "world/weather/particle_set.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr int kClasses = 10;
constexpr double kPi64 = 3.14159265358979323846;

/// Divides `from` … `to` [mm] into classes of equal ratio; number(D) [1/(m³ mm)], diameter(D) [mm]
/// and speed(D) [m/s] of what has, or melts to, a diameter D.
template <class Number, class Diameter, class Speed>
void add_classes(double from, double to, const Number& number, const Diameter& diameter,
                 const Speed& speed, ParticleSet* set) {
  constexpr int kParts = 64;  // parts of a class, for its integrals
  const double ratio = std::pow(to / from, 1.0 / kClasses);
  double low = from, water = 0;
  for (int i = 0; i < kClasses; ++i, low *= ratio) {
    const double step = low * (ratio - 1) / kParts;
    double count = 0, area = 0, flux = 0;
    for (int k = 0; k < kParts; ++k) {
      const double D = low + (k + 0.5) * step, n = number(D) * step;
      count += n;
      area += n * diameter(D) * diameter(D);
      flux += n * speed(D);
      water += n * kPi64 / 6 * std::pow(1e-3 * D, 3) * 1000;
    }
    // A class has the number of particles, all of its own diameter, that cover the area of its part
    // of the distribution.
    set->classes.push_back({static_cast<float>(1e-3 * std::sqrt(area / count)),
                            static_cast<float>(count), static_cast<float>(flux / count)});
  }
  set->water = static_cast<float>(water);
}

}  // namespace

float ParticleSet::cover() const {
  double sum = 0;
  for (const ParticleClass& c : classes)
    sum += static_cast<double>(c.number) * kPi64 / 4 * c.diameter * c.diameter;
  return static_cast<float>(sum);
}

ParticleSet rain_particles(double rate) {
  ParticleSet set;
  set.kind = ParticleKind::kDrop;
  const double slope = 4.1 * std::pow(rate, -0.21);  // [1/mm]
  add_classes(
      0.1, 6.0, [&](double D) { return 8000 * std::exp(-slope * D); }, [](double D) { return D; },
      [](double D) { return std::max(9.65 - 10.3 * std::exp(-0.6 * D), 4.0 * D); }, &set);
  return set;
}

ParticleSet snow_particles(double rate) {
  ParticleSet set;
  set.kind = ParticleKind::kFlake;
  const double slope = 2.55 * std::pow(rate, -0.48), most = 3800 * std::pow(rate, -0.87);
  const auto flake = [](double D) { return std::sqrt(D * D * D / 0.17); };  // [mm]
  add_classes(
      0.3, 5.0, [&](double D) { return most * std::exp(-slope * D); }, flake,
      [&](double D) { return 0.8 * std::pow(flake(D), 0.16); }, &set);
  return set;
}

MediumDescription medium_of(const ParticleSet& particles) {
  MediumDescription medium;
  const bool drops = particles.kind == ParticleKind::kDrop;
  medium.name = drops ? "rain" : "snowfall";
  medium.mass_extinction.fill(particles.extinction() / particles.water);
  if (drops) {
    medium.albedo = {1, 1, 1, 1, 0.9f, 0.55f};
    medium.g.fill(0.94f);
  } else {
    medium.albedo = {1, 1, 1, 1, 0.8f, 0.5f};
    medium.g.fill(0.89f);
  }
  return medium;
}

}  // namespace gloam

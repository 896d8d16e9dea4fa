#pragma once
// Things strewn through the air at random that are too large to be a medium: drops and flakes. A
// set is a pure function of (seed, time): nothing is kept from one instant to the next.

#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "world/media/medium_description.h"
#include "world/weather/gusts.h"

namespace gloam {

/// Particles of about one size.
struct ParticleClass {
  float diameter = 0;    ///< [m]
  float number = 0;      ///< mean, of Poisson's law [1/m³]
  float fall_speed = 0;  ///< in still air [m/s]

  /// With which they follow the air's velocity, of what falls by its drag [s].
  double lag() const { return static_cast<double>(fall_speed) / 9.81; }
};

enum class ParticleKind : uint8_t {
  kDrop,   ///< drop of water: it refracts light from behind it
  kFlake,  ///< flake of ice: it scatters light from all sides
};

struct ParticleSet {
  ParticleKind kind = ParticleKind::kDrop;
  std::vector<ParticleClass> classes;  ///< from small to large
  Vec3f wind;                          ///< mean, that carries them all [m/s]
  std::shared_ptr<const Gusts> gusts;  ///< gusts that carry them; null = none
  uint64_t seed = 0;

  /// Mean fraction of a view that they cover, per metre [1/m].
  float cover() const;
  /// Density of water in the air [kg/m³].
  float water = 0;
  /// Extinction of light, twice the covered fraction: light that passes by a large particle is
  /// diffracted (van de Hulst 1957, "Light scattering by small particles", 8.1) [1/m].
  float extinction() const { return 2 * cover(); }
};

/// Rain of `rate` mm/h: sizes of Marshall and Palmer 1948, "The distribution of raindrops with
/// size", from 0.1 to 6 mm; fall speeds of Atlas, Srivastava and Sekhon 1973, "Doppler radar
/// characteristics of precipitation at vertical incidence", below 0.3 mm 4 m/s per mm (Gunn and
/// Kinzer 1949).
ParticleSet rain_particles(double rate);

/// Snowfall of `rate` mm/h of water: sizes of Gunn and Marshall 1958, "The distribution with size
/// of aggregate snowflakes", of flakes that would melt to drops of 0.3 to 5 mm; a flake's density
/// is 170 kg/m³ mm over its diameter (Holroyd 1971, as in Fabry and Szyrmer 1999, "Modeling of the
/// melting layer, part II"); speeds of unrimed aggregates by Locatelli and Hobbs 1974, "Fall speeds
/// and masses of solid precipitation particles".
ParticleSet snow_particles(double rate);

/// The set as the medium that it is from afar. Drops: mean cosine of scattering of large spheres of
/// water, half of it diffracted forwards; flakes: as of compacted snow grains (Warren 1982).
MediumDescription medium_of(const ParticleSet& particles);

}  // namespace gloam

#pragma once
// Splashes of raindrops: some droplets that fly up from the rim of the crown and fall back. A pure
// function of (seed, time), as the drops in the air are: as many land on an area as fall on it, but
// not the very ones that are drawn in the air.

#include <vector>

#include "base/rng.h"
#include "world/weather/particle_set.h"

namespace gloam {

/// Drops of this class splash: Ohnesorge's number times Reynolds' to the power 1.25 is above 57.7
/// (Mundo, Sommerfeld and Tropea 1995, "Droplet-wall collisions").
bool splashes(const ParticleClass& kind);

struct Splash {
  Vec2f at;         ///< level place [m]
  double time = 0;  ///< time of the impact [s]
  Philox4 bits;     ///< draws of its own
};

/// An edge of the squares that splashes are sampled for [m].
inline constexpr float kSplashCell = 0.25f;
inline constexpr int kSplashDroplets = 7;
inline constexpr float kDropletSize = 0.25f;  ///< diameter, of the drop's: they are a ninth of it

/// One droplet of a splash: where it leaves from, beside the impact [m], and how fast [m/s].
struct SplashDroplet {
  Vec3f from, velocity;
  float diameter = 0;  ///< [m]
};
SplashDroplet splash_droplet(const ParticleClass& kind, const Splash& splash, int number);

/// The thin wall that stands around the impact for some hundredths of a second, and its rim.
struct Crown {
  float radius = 0, rim_radius = 0, height = 0;  ///< at its foot; of the rim [m]
  float rim = 0;                                 ///< thickness [m]
  float cover = 0;  ///< opacity of the crown's foot and rim; 0 = it is gone
};
inline constexpr float kWallCover = 0.25f;  ///< opacity of the wall, over the rim's

/// `t`: after the impact [s]. On a film as deep as the drop is wide its radius is that of Yarin and
/// Weiss 1995, "Impact of drops on solid surfaces: self-similar capillary waves, and splashing as a
/// new type of kinematic discontinuity". How high it rises and when it is gone is chosen.
Crown crown_at(const ParticleClass& kind, float t);

/// After which the last droplet has fallen back to level ground [s].
double splash_life(const ParticleClass& kind);

/// Adds those of class `row` of the set that begin at times in [from, to) [s] in the square whose
/// low corner is (i, j) times kSplashCell.
void find_splashes(const ParticleSet& set, uint32_t row, int64_t i, int64_t j, double from,
                   double to, std::vector<Splash>* out);

}  // namespace gloam

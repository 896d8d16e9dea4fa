#pragma once
// Gusts of wind: stationary Gaussian turbulence as a pure function of time, with Kaimal's spectra,
// as IEC 61400-1 (annex B) has them, f S(f) / s² = 4 f L/U / (1 + 6 f L/U)^(5/3), across and
// upright with 0.8 and 0.5 of the standard deviation along the wind, as sums of sinusoids with
// random frequencies and phases (Shinozuka and Deodatis 1991). From 1/600 Hz, so that they have the
// mean of zero over the ten minutes that winds are measured in, to 5 Hz; the same at all heights
// and places.

#include <array>

#include "world/weather/wind_description.h"

namespace gloam {

class Gusts {
 public:
  /// The wind blows.
  explicit Gusts(const WindDescription& wind);

  /// Deviation from the mean velocity [m/s], world.
  Vec3 at(double time) const;

  /// Deviation of something that takes on the air's velocity with the time constant `lag` [s]: of
  /// its velocity from the mean [m/s], and of its place since time 0 [m].
  Vec3 carry(double time, double lag) const;
  Vec3 way(double time, double lag) const;

 private:
  static constexpr int kTones = 64;
  struct Tone {
    double amplitude, omega, phase;
  };
  Vec3 to_world(const double* sum) const;
  double along_x_, along_y_;
  std::array<std::array<Tone, kTones>, 3> tones_;  // along, across, up
};

}  // namespace gloam

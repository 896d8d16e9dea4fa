#pragma once
// Content of air at each height, transmittance of the sun's beam, and light from more than one
// scattering. Used by world/sky/atmosphere.h, where the model is described. Lengths in metres from
// the centre of the earth.

#include <vector>

#include "world/materials/spectrum.h"

namespace gloam {

/// Scattering and extinction [1/m] at one height, light in the aerosol's forward peak left out of
/// both: it goes on with the beam.
struct AirAt {
  Bands rayleigh, aerosol, extinction;
};

/// A point of a ray, for a piece of it.
struct AirStep {
  double t = 0, r = 0;  ///< along the ray; from the centre
  double horizon = 0;   ///< zenith angle of the horizon there [rad]
  Bands rayleigh;       ///< light scattered towards the start of the ray by the piece, per
  Bands aerosol;        ///< radiance from all sides (phase function apart)
};
struct AirRay {
  std::vector<AirStep> steps;
  bool meets_ground = false;
  double length = 0;
  Bands transmittance;  ///< over the whole ray
};

/// Share of the sun's disc above a horizon that lies `above` [rad] below its centre.
double visible_share_of_sun(double above);

class Air {
 public:
  Air(double turbidity, double ground_albedo, double altitude);

  double ground() const { return ground_; }
  /// Part of the sun's irradiance that reaches the radius r, straight or in the forward peak, the
  /// sun's zenith angle being `angle` there [rad] and that of the horizon `horizon`.
  Bands sunlight(double r, double angle, double horizon) const;
  /// The straight beam alone: what a surface gets from the sun's disc.
  Bands beam(double r, double angle) const;
  double horizon(double r) const;
  /// A ray from the radius r with zenith cosine mu to the ground or out of the air.
  AirRay march(double r, double mu, int count) const;

  /// Prepares `scattered` for sun zenith angles (at the place that sees them) within reach of a
  /// view from the ground where it is `angle`.
  void prepare_scattered(double angle);
  /// Mean radiance over all directions of light that was scattered at least once, or came from the
  /// ground, per solar irradiance.
  Bands scattered(double r, double angle) const;

  double ground_albedo() const { return albedo_; }

 private:
  AirAt at(double r) const;
  void fill_sunlight();
  Bands scattered_at(double r, double angle, const std::vector<AirRay>& rays) const;

  double ground_, albedo_;
  Bands rayleigh_, aerosol_, aerosol_extinction_, aerosol_peak_, ozone_;  ///< [1/m] at unit density
  std::vector<Bands> sunlight_;   ///< (kRadii x kCosines) of the whole sun, by column lengths
  std::vector<Bands> scattered_;  ///< (kHeights x kAngles)
  double first_angle_ = 0;
};

/// Phase functions [1/sr] of the angle's cosine between the sun's beam and the view.
double rayleigh_phase(double cosine);
double aerosol_phase(double cosine);
/// For the first scattering, which has its peak: to go with AirStep::aerosol, which has not
/// (Nakajima and Tanaka 1988, "Algorithms for radiative intensity calculations in moderately thick
/// atmospheres using a truncation approximation").
double single_aerosol_phase(double cosine);

}  // namespace gloam

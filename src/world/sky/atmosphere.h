#pragma once
// Clear sky and sun from the physics of air. Molecules (Rayleigh), aerosol and ozone in a round
// atmosphere; the first scattering is integrated exactly along every ray with the sun's beam
// attenuated by all three, all further ones come from the mean radiance at each height by the
// closure of Hillaire 2020, "A scalable and production ready sky and atmosphere rendering
// technique" (isotropic, light from the ground included; a part of the aerosol's forward peak stays
// with the beam), in sixteen bands of wavelength. Against path tracing of the same air, luminance
// is within a tenth at turbidity 2 (within a third beside a sun on the horizon and in twilight),
// within a third at turbidity 5 (half beside a set sun).
//
// The model: molecules of the U.S. Standard Atmosphere 1976; 300 Dobson units of ozone in a
// triangle from 10 to 40 km; aerosol of scale height 1.2 km, Ångström exponent 1.3,
// single-scattering albedo 0.95, Cornette-Shanks phase function with g = 0.7 (continental aerosol:
// Hess, Koepke and Schult 1998, "Optical properties of aerosols and clouds"). No clouds, no water
// vapour, no refraction, no moon: the night has the 2e-4 cd/m² of stars and airglow alone (Leinert
// et al. 1998).

#include <vector>

#include "base/vec.h"
#include "gloam/result.h"

namespace gloam {

/// Mean angular radius of the sun [rad].
inline constexpr double kSunAngularRadius = 4.654e-3;

struct AtmosphereOptions {
  Vec3f to_sun{0, 0, 1};  ///< towards the apparent sun, unit, Z up
  double turbidity = 3;   ///< 1..10: (molecules + aerosol) / molecules, vertical optical depths
                          ///< at 550 nm from sea level up; 2 very clear, 3 clear, 6 hazy
  double ground_albedo = 0.2;     ///< 0..1, of a grey matt ground everywhere
  double altitude = 0;            ///< height of the ground above sea level [m], 0..9000
  int width = 512, height = 256;  ///< size of the map [texels], 8 x 4 to 8192 x 4096; height even
};

struct SkyLight {
  int width = 0, height = 0;
  /// (height x width), linear Rec. 709 [cd/m²], equirectangular: row 0 at the zenith, the middle
  /// column towards +X, columns to the right by -Y; seen 2 m above the ground, the sun left out.
  std::vector<Vec3f> texels;
  /// Illuminance of a surface that faces the sun [lx], linear Rec. 709; zero when set
  Vec3f sun_illuminance;
  double sun_angular_radius = kSunAngularRadius;
  Vec3f sky_illuminance;  ///< illuminance of a level surface, by the sky without the sun [lx]
};

/// Errors: an option outside of its range; the message names it.
Result<SkyLight> make_sky(const AtmosphereOptions& options);

}  // namespace gloam

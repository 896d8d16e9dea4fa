#pragma once
// Sunlight in bands of wavelength, what air does to each, and the way back to colour.

#include <array>
#include <cstdint>

#include "base/vec.h"

namespace gloam {

/// Sixteen bands of 20 nm from 380 nm; band i is about kFirstBand + 20 i nm.
inline constexpr int kBandCount = 16;
inline constexpr double kFirstBand = 390, kBandWidth = 20;  // [nm]
using Bands = std::array<float, kBandCount>;

/// CIE 1931 2° colour matching functions at a wavelength [nm], by the multi-lobe fit of Wyman,
/// Sloan and Shirley 2013, "Simple analytic approximations to the CIE XYZ color matching
/// functions" (its error is about 1 % of the peak).
struct Xyz {
  double x = 0, y = 0, z = 0;
};
Xyz color_matching(double wavelength);

/// Linear Rec. 709 (primaries and D65 of ITU-R BT.709); channels below zero are out of its gamut.
std::array<double, 3> rec709_of(Xyz color);

/// The same within the gamut, of the same luminance: colours outside of it
/// go towards grey of the same luminance until none is negative.
Vec3f color_of_xyz(Xyz color);

/// Linear Rec. 709 with luminance in [cd/m²] (illuminance in [lx]) of light that has `share` of the
/// sun's spectral irradiance above the air in each band, per steradian (or not). The sun: ASTM
/// G173-03, extraterrestrial, at 1 au. Within a band `share` is constant; light from 700 to 720 nm
/// counts to the last one.
Vec3f color_of_sunlight(const Bands& share);

/// Scattering cross-section of a molecule of dry air [m²]: Bodhaine et al. 1999, "On Rayleigh
/// optical depth calculations", equations 4 to 6 and 22, without the correction for CO2.
double rayleigh_cross_section(double wavelength);

/// Absorption cross-section of an ozone molecule at 233 K [m²], mean over band i: Serdyuchenko et
/// al. 2014, "High spectral resolution ozone absorption cross-sections, part 2".
double ozone_cross_section(int band);

}  // namespace gloam

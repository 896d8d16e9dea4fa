#pragma once
// How bright and of which colour glowing things are.

#include <vector>

#include "render/kernel/medium_view.h"

namespace gloam {

/// Luminance of a black body at `temperature` [K] per channel of linear Rec. 709 [cd/m²]: Planck's
/// law with the constants of the SI of 2019, over the CIE 1931 functions as fitted by Wyman, Sloan
/// and Shirley 2013, "Simple analytic approximations to the CIE XYZ color matching functions"
/// (within 1 % of their peaks). What lies outside the gamut (blue below some 1900 K) is clipped;
/// luminance is kept.
Vec3f black_body_luminance(double temperature);

/// What BlackBodyTable reads.
std::vector<Vec3f> make_black_body_table();

}  // namespace gloam

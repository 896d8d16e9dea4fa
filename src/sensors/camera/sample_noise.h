#pragma once
// Noise that is left in a picture of few samples, and whether a denoiser can mend it.

#include "render/film/film.h"

namespace gloam {

/// Error of pixels, relative to the light around them, up to which a denoiser finds a picture's
/// light; above it the few pixels that hold the light are new in every picture. Judged by eye on
/// rooms full of smoke.
inline constexpr double kMaxDenoisableError = 2;

/// Standard error of pixels over the mean light of their block of 8 x 8, as a median over the
/// blocks that have light; 0 without Film::variance.
double pixel_error(const Film& film);

/// Samples per pixel, a power of two, that bring pixel_error() down to kMaxDenoisableError; `spp`
/// where that many do.
int samples_needed(const Film& film, int spp);

}  // namespace gloam

#pragma once
// From light to numbers: the linear camera model of EMVA 1288, release 4.0 (2021), equations 2 to
// 11: photons become electrons (Poisson), the dark adds some, the read-out adds normal noise, the
// converter rounds. Pixels differ in sensitivity (PRNU) and offset (DSNU), fixed per seed.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "gloam/scene/imager.h"
#include "sensors/imager/exposure.h"

namespace gloam {

/// `sites` light-sensitive places: one per pixel behind a mosaic, three without one.
class PixelArray {
 public:
  PixelArray(const PixelOptions& options, size_t sites, uint64_t seed);

  /// Factors from light to electrons in an exposure.
  struct Gains {
    double electrons_per_light = 0;  ///< per cd/m²
    double dark_electrons = 0;
    double numbers_per_electron = 0;  ///< the system gain K [DN/e-]; without bits [1/e-]
  };
  Gains gains(const Exposure& exposure) const;

  /// Reading of site i for `light` [cd/m²] in a picture's frame: a number of the converter [DN], or
  /// without bits a fraction of the top of the scale.
  double read(const Gains& gains, double light, uint64_t frame, size_t i) const;
  /// The reading as a fraction of the top of the scale; noise may take it below 0.
  double share(double reading) const {
    return (reading - options_.black_level * quantised_) /
           (top_ - options_.black_level * quantised_);
  }
  /// Share of the top of the scale at which a pixel is full: its well, or the converter.
  double full_share(const Gains& gains) const {
    return std::min(1.0, options_.full_well * gains.numbers_per_electron /
                             (top_ - options_.black_level * quantised_));
  }
  bool quantised() const { return quantised_ != 0; }

 private:
  PixelOptions options_;
  uint64_t seed_;
  int quantised_;                     // 1 or 0
  double top_;                        // largest reading
  std::vector<float> gain_, offset_;  // per site: factor, electrons; empty = all alike
};

}  // namespace gloam

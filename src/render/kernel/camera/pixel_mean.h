#pragma once
// Running means of a pixel's samples. Device-safe.

#include "render/kernel/path/path_state.h"

namespace gloam {

/// Mean over the samples of a pixel and the variance of that mean (Welford 1962).
struct PixelMean {
  Vec3f radiance, squares, albedo, normal;
  int count = 0;

  GLOAM_HD void add(const PathResult& sample) {
    ++count;
    const float weight = 1.0f / static_cast<float>(count);
    const Vec3f delta = sample.radiance - radiance;
    radiance += delta * weight;
    squares += delta * (sample.radiance - radiance);
    albedo += (sample.albedo - albedo) * weight;
    normal += (sample.normal - normal) * weight;
  }
  /// Adds the samples of another part (Chan, Golub and LeVeque 1979).
  GLOAM_HD void merge(const PixelMean& part) {
    if (part.count == 0) return;
    const int both = count + part.count;
    const float weight = static_cast<float>(part.count) / static_cast<float>(both);
    const Vec3f delta = part.radiance - radiance;
    radiance += delta * weight;
    squares += part.squares + delta * delta * (weight * static_cast<float>(count));
    albedo += (part.albedo - albedo) * weight;
    normal += (part.normal - normal) * weight;
    count = both;
  }
  GLOAM_HD Vec3f variance() const {
    return count < 2 ? Vec3f{}
                     : squares / (static_cast<float>(count) * static_cast<float>(count - 1));
  }
};

}  // namespace gloam

#pragma once
// Adaptive sampling of one tile of the path tier.
//
// RenderSettings::error is the root mean square over the picture of the pixels' relative errors.
// The fewest samples reach it when their number in each block of pixels goes with the deviation of
// one sample there (Neyman 1934, "On the two different aspects of the representative method"). So a
// few samples everywhere tell the mean deviation and with it how many samples a deviation of 1
// deserves; then blocks are sampled in rounds that double, until they have what they deserve by
// what they show. None has less than half of what the picture needs on the mean: light that is rare
// is seen in the picture long before it is seen in every block.
//
// The mean of a pixel is that of two halves, sampled with scramblings of their own, so independent.
// How many samples count in one half is decided by what the other half shows alone: a count that
// depends on the very values it counts favours dark ones (Kirk and Arvo 1991, "Unbiased sampling
// techniques for image synthesis"). So the picture is unbiased, whatever the scene. What a half has
// sampled beyond its count, to decide for the other, is not used; nor are the first few samples.
//
// The variance of a half's mean is estimated from the means of four runs of its samples (batch
// means), so that what runs gain by their low discrepancy is in it. It is compared with a pixel's
// value, the mean over its channels, of those two runs that are neither the darkest nor the
// brightest, averaged with that of the block, and at least error_floor.

#include "render/cpu/path/tile.h"

namespace gloam {

struct AdaptivePlan {
  int least = 0;             ///< samples of a half before the first decision
  double per_deviation = 0;  ///< samples of a pixel per relative deviation of one of its samples
};

/// Looks at a few samples of one tile, which count in no mean. Returns the root mean square over
/// its pixels of the relative deviation of single samples.
double look_adaptive(const Job& job, int x0, int y0, RenderStats* stats);

/// Plan by the `deviations` of all tiles and the number of pixels of each.
AdaptivePlan plan_adaptive(const RenderSettings& settings, const std::vector<double>& deviations,
                           const std::vector<int>& pixels);

/// Fills the film's light, guides and sample counts of one tile; settings.spp is the most of them
/// (of an odd number, one less). `job.log2_samples` is for one half.
void render_adaptive(const Job& job, int x0, int y0, const AdaptivePlan& plan, RenderStats* stats);

}  // namespace gloam

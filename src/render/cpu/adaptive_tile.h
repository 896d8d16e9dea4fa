#pragma once
// Adaptive sampling of one tile of the path tier: blocks of pixels are sampled in rounds that
// double until their error is small enough.
//
// The mean of a pixel is that of two halves, drawn with scramblings of their own, so independent.
// How many samples count in one half is decided by the errors that the other half shows alone: a
// count that depends on the very values it counts favours dark ones (Kirk and Arvo 1991, "Unbiased
// sampling techniques for image synthesis"). So the picture is unbiased, whatever the scene. What a
// half has drawn beyond its count, to decide for the other, is not used.
//
// The variance of a half's mean is estimated from the means of four runs of its samples (batch
// means), so that what runs gain by their low discrepancy is in it. The error of a pixel is the
// root mean square over its channels of the standard error / max(value, error_floor), value being
// the mean of the channels; that of a block is the root mean square over its pixels.

#include "render/cpu/tile.h"

namespace gloam {

/// Looks at a few samples of one tile, which count in no mean. Returns the sum over its pixels of
/// the squares of the errors that one sample has.
double look_adaptive(const Job& job, int x0, int y0, RenderStats* stats);

/// Samples of a half before the first decision: half of what an even picture whose samples have
/// `square_error`, the mean over its pixels, would need. Light that is rare is seen in the picture
/// long before it is seen in every block.
int least_adaptive(const RenderSettings& settings, double square_error);

/// Fills the film's light, guides and sample counts of one tile until settings.error is reached or
/// settings.spp samples are drawn (of an odd number, one less). `job.log2_samples` is for one half.
void render_adaptive(const Job& job, int x0, int y0, int least, RenderStats* stats);

}  // namespace gloam

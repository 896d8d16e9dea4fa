#pragma once
// Directions from which light comes to the rows of the light guide.

#include "render/cpu/guide/guide_grid.h"

namespace gloam {

/// LightGuide::arriving of all rows. Rays from each find what shines there: the sky, and surfaces
/// by the light on them, which is that of the scene's lights, with shadows, and what the rows where
/// they lie reflect among themselves. Lights count by what they light alone: they are sampled
/// directly. `grid`: with its surface rows.
std::vector<float> find_arriving_light(const SceneView& scene, const CpuTracer& statics,
                                       const LightGuide& grid, const std::vector<GuideRow>& rows);

/// Unevenness of light over directions: the relative variance of the sum of what arrives at
/// surfaces, estimated by one direction by the cosine alone, a mean over the rows. 0: it comes
/// evenly from all around.
float unevenness_of(const std::vector<float>& arriving, const std::vector<GuideRow>& rows);

}  // namespace gloam

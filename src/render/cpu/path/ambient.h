#pragma once
// The direct tier's stand-in for reflected light and the sky.

#include "render/cpu/tracer/embree_scene.h"
#include "render/kernel/light/ambient_path.h"

namespace gloam {

/// Light that surfaces in view receive, by the axis that they face, beyond that straight from lamps
/// and suns: the mean over paths of at most `max_depth` segments from the camera on. They are the
/// same in every picture, so that what they find changes no faster than the view does.
AmbientCube measure_ambient(const SceneView& scene, const CpuTracer& tracer,
                            const CameraView32& camera, int width, int height, int max_depth);

}  // namespace gloam

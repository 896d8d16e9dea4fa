#pragma once
// The direct tier's stand-in for reflected light and the sky.

#include "render/cpu/embree_scene.h"
#include "render/kernel/camera.h"

namespace gloam {

/// What surfaces in view receive, by the axis that they face, beyond the light of lamps and suns
/// themselves: found by some paths from points that the camera sees, of at most `max_depth`
/// segments from the camera on. The paths are the same in every picture, so that it changes no
/// faster than the view does.
AmbientCube measure_ambient(const SceneView& scene, const EmbreeTracer& tracer,
                            const CameraView32& camera, int width, int height, int max_depth);

}  // namespace gloam

#pragma once
// Cleaner albedo and normals for a denoiser than the few samples of a picture have.

#include "render/cpu/tracer/embree_scene.h"
#include "render/kernel/camera/camera.h"
#include "render/renderer.h"
#include "render/slices.h"

namespace gloam {

struct EdgeSamples {
  const SceneView& scene;
  const CpuTracer& tracer;
  const CameraView32& camera;
  bool has_motion = false;  ///< something moves while the shutter is open
};

/// Guides for the denoiser. In pixels where shape and albedo hardly change, the film's albedo and
/// normal become those at the pixel's centre; at edges, the mean over `count` rays through the
/// pixel's filter, which end at the first surface. Media before it take their part, with their own
/// albedo and no normal. The film has the exact channels. Returns the rays traced.
uint64_t refine_guides(const EdgeSamples& job, int count, RenderSlices* slices, Film* film);

}  // namespace gloam

#pragma once
// Smooth edges for the fast tier, which shades one point of each pixel.

#include "render/cpu/embree_tracer.h"
#include "render/cpu/fast_frame.h"
#include "render/film/film.h"
#include "render/kernel/camera.h"

namespace gloam {

/// At edges, film->radiance becomes the mean over rays through the pixel's filter: each takes the
/// light of the pixel nearby that shows the same surface, or what its own surface gives off.
/// Returns the rays traced.
uint64_t smooth_edges(const SceneView& scene, const EmbreeTracer& tracer,
                      const CameraView32& camera, const FastFrame& frame, Film* film);

}  // namespace gloam

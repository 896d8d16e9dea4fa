#pragma once
// Illuminance, as a lux meter shows it.

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/scene_view.h"

namespace gloam {

/// Illuminance [lx] of a surface at p_W that faces n_W, by paths of at most `max_depth` segments
/// from there. All emitters count: lamps, the sun, the sky, surfaces and media that glow, and light
/// that media scatter. Samples until the standard error is 0.5 %, at most 16384 paths; the same
/// number in every call.
float measure_illuminance(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W, Vec3f n_W,
                          int max_depth);

}  // namespace gloam

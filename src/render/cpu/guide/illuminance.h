#pragma once
// Illuminance, as a lux meter shows it.

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/scene_view.h"

namespace gloam {

/// Illuminance [lx] of a surface at p_W that faces n_W, by paths of at most `max_depth` segments.
/// The same in every call.
float measure_illuminance(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W, Vec3f n_W,
                          int max_depth);

}  // namespace gloam

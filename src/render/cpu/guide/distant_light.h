#pragma once
// Light from far away that reaches a camera's lens.

#include <span>

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/scene_view.h"

namespace gloam {

/// Fractions of the light of each direction (unit, world) that reach p_W, into `passed`: through
/// surfaces that let light through, and media. The tracer's clip is that of a camera at p_W. The
/// same in every call.
void measure_distant_light(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W,
                           std::span<const Vec3f> directions, std::span<float> passed);

}  // namespace gloam

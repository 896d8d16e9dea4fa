#pragma once
// Pixels of each object that a camera sees, and that it would see with nothing in front.

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/film/film.h"
#include "render/kernel/camera/camera.h"

namespace gloam {

/// Cover by object, which `object_of` tells for every instance (0 = none): counts the pixels whose
/// centre ray meets the object first, and those whose ray meets it at all.
std::map<uint32_t, ObjectCover> measure_cover(const SceneView& scene, const CpuTracer& tracer,
                                              const CameraView32& camera, bool has_motion,
                                              int width, int height,
                                              const std::vector<uint32_t>& object_of);

}  // namespace gloam

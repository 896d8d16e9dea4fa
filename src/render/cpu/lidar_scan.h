#pragma once
// The LiDAR kernel over Embree's packets and all threads of parallel_for.

#include <span>

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/lidar_view.h"
#include "render/slices.h"

namespace gloam {

/// `returns`: view.optics.most_returns of each beam, in the order of the beams.
void scan_beams(const SceneView& scene, const CpuTracer& tracer, const LidarView& view,
                RenderSlices* slices, std::span<LidarReturn> returns);

}  // namespace gloam

#include "render/cpu/path/ambient.h"

#include <vector>

#include "base/parallel.h"

namespace gloam {
namespace {

std::vector<AmbientPath> trace_ambient(const SceneView& scene, const CpuTracer& tracer,
                                       const CameraView32& camera, int width, int height,
                                       int max_depth) {
  std::vector<AmbientPath> paths(size_t{1} << kLog2AmbientPaths);
  parallel_for_range(
      "ambient light", static_cast<int64_t>(paths.size()), 64, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
          paths[static_cast<size_t>(i)] = ambient_path(scene, tracer, camera, width, height,
                                                       max_depth, static_cast<uint32_t>(i));
        }
      });
  return paths;
}

}  // namespace

AmbientCube measure_ambient(const SceneView& scene, const CpuTracer& tracer,
                            const CameraView32& camera, int width, int height, int max_depth) {
  AmbientSum sums[LightGuide::kFacings], all;
  for (const AmbientPath& path : trace_ambient(scene, tracer, camera, width, height, max_depth)) {
    if (path.facing < 0) continue;
    for (AmbientSum* sum : {&sums[path.facing], &all}) {
      sum->light += path.light;
      sum->count += 1;
    }
  }
  return mean_ambient(sums, all);
}

}  // namespace gloam

#include "render/cpu/path/ambient.h"

#include "base/parallel.h"

namespace gloam {

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

AmbientCube mean_ambient(const std::vector<AmbientPath>& paths) {
  constexpr float kPriorFraction = 0.05f;  // of all paths, for the mean over all facings
  Vec3f by_facing[LightGuide::kFacings], light;
  float count[LightGuide::kFacings] = {}, found = 0;
  for (const AmbientPath& path : paths) {
    if (path.facing < 0) continue;
    by_facing[path.facing] += path.light;
    count[path.facing] += 1;
    light += path.light;
    found += 1;
  }
  AmbientCube ambient;
  if (found == 0) return ambient;
  const float usual = kPriorFraction * static_cast<float>(paths.size());
  for (int k = 0; k < LightGuide::kFacings; ++k) {
    ambient.light[k] = (by_facing[k] + light * (usual / found)) / (count[k] + usual);
  }
  return ambient;
}

}  // namespace gloam

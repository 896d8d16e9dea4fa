#include "render/cpu/guide/distant_light.h"

#include "render/kernel/path/path_state.h"

namespace gloam {

void measure_distant_light(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W,
                           std::span<const Vec3f> directions, std::span<float> passed) {
  constexpr int kLog2Directions = 10;
  for (size_t i = 0; i < directions.size(); ++i) {
    Ray ray;
    ray.o = p_W;
    ray.d = directions[i];
    passed[i] = 0;
    RayHit hit;
    Vec3f light{1, 1, 1};
    // Rays from the lens pass what the camera does not see; the first hit alone tells of that.
    if (tracer.closest(ray, true, false, &hit)) {
      if (!scene.lets_light_through()) continue;
      uint32_t rays = 0;
      light = paths::transmit(scene, tracer, ray, true, &rays);
    }
    Sampler sampler = Sampler::make(0, 0, 0, 0, static_cast<uint32_t>(i), kLog2Directions);
    light *= paths::through_media(scene, ray, true, &sampler);
    passed[i] = luminance(light);
  }
}

}  // namespace gloam

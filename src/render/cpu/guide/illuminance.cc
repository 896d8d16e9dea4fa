#include "render/cpu/guide/illuminance.h"

#include <vector>

#include "base/parallel.h"
#include "render/kernel/light/ambient_path.h"

namespace gloam {
namespace {

constexpr int kLog2Rays = 10;

/// Illuminance of lamps and the sun, by one sample [lx].
Vec3f direct_light(const SceneView& scene, const CpuTracer& tracer, Vec3f p, Vec3f n,
                   Sampler* sampler) {
  if (scene.lights.size == 0) return {};
  LightSampler light_sampler;
  light_sampler.prepare(scene, p, n);
  light_sampler.leave_out_sky(scene);
  const LightSample light = light_sampler.sample(scene, p, sampler->next_2d(), 0.0f);
  const float cosine = dot(light.wi, n);
  if (!(light.pdf > 0) || !(cosine > 0)) return {};
  Ray shadow;
  shadow.o = p;
  aim_shadow_ray(p, n, 0.0f, light, &shadow);
  Vec3f passed{1, 1, 1};
  uint32_t rays = 0;
  if (light.casts_shadow) passed = paths::transmit(scene, tracer, shadow, true, &rays);
  passed *= paths::through_media(scene, shadow, true, sampler);
  return light.radiance * passed * (cosine / light.pdf);
}

}  // namespace

float measure_illuminance(const SceneView& seen, const CpuTracer& tracer, Vec3f p_W, Vec3f n_W,
                          int max_depth) {
  SceneView scene = seen;
  scene.has_visible_lights = false;  // direct_light() has them
  std::vector<float> light(size_t{1} << kLog2Rays);
  parallel_for_range(
      "illuminance", static_cast<int64_t>(light.size()), 64, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
          Sampler sampler = Sampler::make(0, 0, 0, 0, static_cast<uint32_t>(i), kLog2Rays);
          const Frame frame = Frame::from_z(n_W);
          Ray ray;
          ray.o = p_W;
          ray.d = frame.to_world(sample_cosine_hemisphere(sampler.next_2d()));
          Vec3f sum = direct_light(scene, tracer, p_W, n_W, &sampler);
          RayHit hit;
          constexpr float kSpread = 0.2f;
          if (scene.has_media() && !tracer.trace(ray, false, &hit)) {
            sum += trace_path(scene, tracer, ray, 0.0f, kSpread, {max_depth, max_depth}, sampler)
                       .radiance *
                   kPi;
          } else {
            sum += ambient::incoming(scene, tracer, ray, max_depth, sampler) * kPi;
          }
          light[static_cast<size_t>(i)] = luminance(sum);
        }
      });
  double sum = 0;
  for (const float one : light) sum += static_cast<double>(one) / static_cast<double>(light.size());
  return static_cast<float>(sum);
}

}  // namespace gloam

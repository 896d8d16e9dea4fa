#include "render/cpu/guide/illuminance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "render/kernel/path/path.h"

namespace gloam {
namespace {

constexpr int kLog2Most = 14;  // paths, at most
constexpr int kBatch = 1024;   // paths between two looks at the error
constexpr double kTargetError =
    0.005;                          // standard error over the mean at which the measurement ends
constexpr float kBroadCone = 0.2f;  // of the paths' rays: no fine texture is sought

/// Irradiance [lx per channel] of one light sample and one path from p, weighted against each other
/// like at any vertex of the path stage: p is a vertex on a white Lambertian surface.
Vec3f sample_irradiance(const SceneView& scene, const CpuTracer& tracer, Vec3f p, Vec3f n,
                        const PathOptions& options, const Sampler& sampler) {
  paths::State<float> path;
  LightProbabilitiesOf<float> probabilities;
  path.light_sampler.keep_in(&probabilities);
  paths::CameraSampleOf<float> start;
  start.ray.o = p;
  start.cone_spread = kBroadCone;
  start.sampler = sampler;
  path.start(start, true);
  path.depth = 1;
  path.from = p;
  path.light_sampler.prepare(scene, p, n);
  if (scene.has_glow()) path.light_sampler.add_glow(scene, true);

  const LightSample light = path.light_sampler.sample(scene, p, path.sampler.next_2d(true), 0.0f);
  if (const float cosine = dot(light.wi, n); light.pdf > 0 && cosine > 0) {
    Ray shadow;
    aim_shadow_ray(p, n, 0.0f, light, &shadow);
    const float weight = light.is_delta ? 1.0f : mis_weight(light.pdf, cosine * kInvPi);
    Vec3f arriving = light.radiance * (cosine * weight / light.pdf);
    if (light.casts_shadow)
      arriving *= paths::transmit(scene, tracer, shadow, true, &path.result.rays);
    // Shadow rays end short of what they aim at; thick media dim on that last bit, too.
    shadow.tmax = length(p + light.wi * light.distance + light.lift - shadow.o);
    path.result.radiance += arriving * paths::through_media(scene, shadow, true, &path.sampler);
  }

  path.ray.d = Frame::from_z(n).to_world(sample_cosine_hemisphere(path.sampler.next_2d(true)));
  path.pdf_bsdf = dot(path.ray.d, n) * kInvPi;
  path.throughput = Vec3f{kPi, kPi, kPi};
  bool active = path.pdf_bsdf > 0;
  while (active) active = paths::advance(scene, tracer, options, false, &path, active);
  return path.result.radiance;
}

}  // namespace

float measure_illuminance(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W, Vec3f n_W,
                          int max_depth) {
  const PathOptions options{max_depth + 1, max_depth + 1};
  std::vector<float> light(kBatch);
  double sum = 0, squares = 0;
  for (int done = 0; done < 1 << kLog2Most;) {
    parallel_for_range("illuminance", kBatch, 64, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i) {
        const auto index = static_cast<uint32_t>(done + i);
        const Sampler sampler = Sampler::make(0, 0, 0, 0, index, kLog2Most);
        light[static_cast<size_t>(i)] =
            luminance(sample_irradiance(scene, tracer, p_W, n_W, options, sampler));
      }
    });
    for (const float one : light) {
      sum += static_cast<double>(one);
      squares += static_cast<double>(one) * static_cast<double>(one);
    }
    done += kBatch;
    const double mean = sum / done, variance = std::max(squares / done - mean * mean, 0.0);
    if (std::sqrt(variance / done) <= kTargetError * mean) return static_cast<float>(mean);
  }
  return static_cast<float>(sum / (1 << kLog2Most));
}

}  // namespace gloam

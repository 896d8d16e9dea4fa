#include "render/cpu/ambient.h"

#include <vector>

#include "base/parallel.h"
#include "render/kernel/channels.h"
#include "render/kernel/path.h"

namespace gloam {
namespace {

constexpr int kChunks = 32, kLog2Paths = 11;  // all together
constexpr float kSpread = 0.2f;               // of the rays' cones: no fine texture is sought
constexpr float kUsualShare = 0.05f;          // of all paths, for the mean over all facings

struct Sum {
  Vec3f light[LightGuide::kFacings];
  float paths[LightGuide::kFacings] = {};
};

/// Light that arrives along the ray, save that of lights which the direct tier samples itself.
Vec3f incoming(const SceneView& scene, const EmbreeTracer& tracer, const Ray& ray, int max_depth,
               Sampler sampler) {
  RayHit hit;
  if (!tracer.trace(ray, false, &hit)) {
    return sky_radiance(scene, ray.d, kSpread) + scene.sky_ambient;
  }
  if (scene.instances[hit.instance].light >= 0) return {};
  constexpr int kRoulette = 3;
  return trace_path(scene, tracer, ray, 0.0f, kSpread, {max_depth - 1, kRoulette}, sampler)
      .radiance;
}

void add_path(const SceneView& scene, const EmbreeTracer& tracer, const CameraView32& camera,
              Vec2f size, int max_depth, uint32_t index, Sum* sum) {
  Sampler sampler = Sampler::make(0, 0, 0, 0, index, kLog2Paths);
  const Vec2f at = sampler.next_2d(), u = sampler.next_2d();
  RayCone cone;
  const Ray view = camera_ray(camera, at.x * size.x, at.y * size.y, 0, &cone);
  Surface s;
  RayHit hit;
  uint32_t rays = 0;
  if (!find_first(scene, tracer, view, cone, &s, &hit, &rays)) return;
  Ray ray;
  ray.d = Frame::from_z(s.geometric).to_world(sample_cosine_hemisphere(u));
  ray.o = leave_surface(s.p, s.geometric, ray.d, s.t);
  const Vec3f light = incoming(scene, tracer, ray, max_depth, sampler);
  const int facing = LightGuide::facing_of(s.geometric);
  sum->light[facing] += light;
  sum->paths[facing] += 1;
}

}  // namespace

AmbientCube measure_ambient(const SceneView& scene, const EmbreeTracer& tracer,
                            const CameraView32& camera, int width, int height, int max_depth) {
  constexpr int kPaths = 1 << kLog2Paths, kPathsOfChunk = kPaths / kChunks;
  const Vec2f size{static_cast<float>(width), static_cast<float>(height)};
  std::vector<Sum> sums(kChunks);
  parallel_for("ambient light", kChunks, [&](int64_t chunk) {
    for (int i = 0; i < kPathsOfChunk; ++i) {
      add_path(scene, tracer, camera, size, max_depth,
               static_cast<uint32_t>(chunk * kPathsOfChunk + i), &sums[static_cast<size_t>(chunk)]);
    }
  });
  Sum all;
  Vec3f light;
  float paths = 0;
  for (const Sum& sum : sums) {
    for (int k = 0; k < LightGuide::kFacings; ++k) {
      all.light[k] += sum.light[k];
      all.paths[k] += sum.paths[k];
      light += sum.light[k];
      paths += sum.paths[k];
    }
  }
  AmbientCube ambient;
  if (paths == 0) return ambient;
  const float usual = kUsualShare * static_cast<float>(kPaths);
  for (int k = 0; k < LightGuide::kFacings; ++k) {
    ambient.light[k] = (all.light[k] + light * (usual / paths)) / (all.paths[k] + usual);
  }
  return ambient;
}

}  // namespace gloam

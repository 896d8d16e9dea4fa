#pragma once
// The kernels of the direct stage and of the exact channels.

#include "render/cuda/pixels.cuh"
#include "render/kernel/path/direct.h"

namespace gloam::cuda {
namespace {

__device__ __forceinline__ void store_channels(const DeviceFilm& film, size_t pixel,
                                               const ExactChannels& c) {
  const auto store = [&](auto* plane, const auto& value) { put(plane + pixel, value); };
  visit_places(store, film, c);
  if (film.center_normal != nullptr) visit_details(store, film, c);
}

__global__ void __launch_bounds__(kBlock, kBlocks)
    direct_kernel(const __grid_constant__ DevicePicture p) {
  __shared__ PixelMean means[kBlock];  // in registers it would crowd out others
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, 1, true);
  uint32_t rays = 0;
  if (at.inside) {
    const size_t pixel = at.pixel(p.width);
    PixelMean& mean = means[threadIdx.x];
    mean = {};
    const bool describes = p.centered && p.film.part != nullptr;
    for (int i = 0; i < p.samples; ++i) {
      RayCone cone;
      Sampler sampler;
      const Ray ray = sample_ray(p, at, p.first_sample + i, p.centered, &cone, &sampler);
      const bool seen = sees(ray);
      DirectState state;
      direct_start(&state, ray, cone, sampler);
      RayHit hit;
      bool found;
      const ViewTracer tracer{p};
      do {
        found = tracer.trace(state.ray, state.any, &hit);
      } while (direct_advance(
          scene, &state, found, hit, [&](const Ray& view, const Surface& s, const RayHit& first) {
            if (!describes) return;
            if (state.has_first && shows(scene, s)) {
              store_channels(p.film, pixel, describe_surface(scene, p.camera, view, s, first));
            } else {
              p.film.part[pixel] = kUnknownPart;
            }
          }));
      mean.add(seen ? state.result : PathResult{});
      rays += state.result.rays;
      if (describes && state.layers == 0) {
        store_channels(p.film, pixel, describe_sky(p.camera, state.ray));
      }
    }
    store_mean(p, pixel, mean);
  }
  count_rays(p.film, rays);
}

__global__ void __launch_bounds__(kBlock, kBlocks)
    channels_kernel(const __grid_constant__ DevicePicture p, bool unknown_alone) {
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, 1, true);
  uint32_t rays = 0;
  const size_t pixel = at.pixel(p.width);
  if (at.inside && (!unknown_alone || p.film.part[pixel] == kUnknownPart)) {
    RayCone cone;
    const float time = !kPlainScenes && p.has_motion ? p.camera.time_of(at.y, 0) : 0.0f;
    const Ray ray = camera_ray(p.camera, static_cast<float>(at.x) + 0.5f,
                               static_cast<float>(at.y) + 0.5f, time, &cone);
    Surface s;
    RayHit hit;
    const bool found = find_first(scene, ViewTracer{p}, ray, cone, &s, &hit, &rays);
    store_channels(
        p.film, pixel,
        found ? describe_surface(scene, p.camera, ray, s, hit) : describe_sky(p.camera, ray));
  }
  count_rays(p.film, rays);
}

}  // namespace
}  // namespace gloam::cuda

#pragma once
// The kernels of the direct stage and of the exact channels.

#include "render/cuda/pixels.cuh"
#include "render/kernel/camera/guides.h"
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

__device__ __forceinline__ Ray center_ray(const DevicePicture& p, const Place& at, bool moves,
                                          RayCone* cone) {
  const float time = moves ? p.camera.time_of(at.y, 0) : 0.0f;
  return camera_ray(p.camera, static_cast<float>(at.x) + 0.5f, static_cast<float>(at.y) + 0.5f,
                    time, cone);
}

/// The guides of a pixel, which is at an edge or shows its centre, before media.
__device__ __forceinline__ bool start_guides(const DevicePicture& p, const Place& at,
                                             size_t pixel) {
  const bool edge = guides::is_edge(p.film, p.width, p.height, at.x, at.y);
  p.film.albedo[pixel] = edge ? Vec3f{} : p.film.center_albedo[pixel];
  p.film.normal[pixel] = edge ? Vec3f{} : p.film.center_normal[pixel];
  return edge;
}

/// A ray of each pixel's centre, or for the guides of edges `samples` rays, with one trace for all.
__global__ void __launch_bounds__(kBlock, kBlocks)
    channels_kernel(const __grid_constant__ DevicePicture p, ChannelRays rays_of) {
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, 1, true);
  const bool for_guides = rays_of == ChannelRays::kGuides;
  const size_t pixel = at.pixel(p.width);
  int count = 0;
  if (at.inside) {
    const bool known = rays_of == ChannelRays::kUnknown && p.film.part[pixel] != kUnknownPart;
    count = for_guides ? (start_guides(p, at, pixel) ? p.samples : 0) : (known ? 0 : 1);
  }
  uint32_t rays = 0;
  for (int k = 0; k < count; ++k) {
    RayCone cone;
    const bool moves = !kPlainScenes && p.has_motion;
    const Ray ray = for_guides ? guides::edge_ray(p.camera, at.x, at.y, k, moves, &cone)
                               : center_ray(p, at, moves, &cone);
    Surface s;
    RayHit hit;
    const bool found = find_first(scene, ViewTracer{p}, ray, cone, &s, &hit, &rays);
    if (!for_guides) {
      store_channels(
          p.film, pixel,
          found ? describe_surface(scene, p.camera, ray, s, hit) : describe_sky(p.camera, ray));
    } else if (found) {  // the sky's guides are zero
      p.film.albedo[pixel] += s.base_color / static_cast<float>(count);
      p.film.normal[pixel] += s.normal / static_cast<float>(count);
    }
  }
  if (for_guides && at.inside && scene.has_media()) {
    const float clear = guides::veil(scene.media, p.camera, at.x, at.y, p.film.distance[pixel],
                                     &p.film.albedo[pixel], &p.film.normal[pixel]);
    if (p.film.clear != nullptr) p.film.clear[pixel] = clear;
  }
  count_rays(p.film, rays);
}

}  // namespace
}  // namespace gloam::cuda

#pragma once
// The kernel of the path stage.

#include "render/cuda/pixels.cuh"
#include "render/kernel/path/path_machine.h"

namespace gloam::cuda {
namespace {

/// Each warp has a tile's pixels and a fraction of their samples; the warps of a tile meet in
/// shared memory, in order.
__global__ void __launch_bounds__(kBlock, kPlainPathBlocks)
    path_kernel(const __grid_constant__ DevicePicture p) {
  __shared__ PixelMean means[kBlock];
  const SceneView& scene = p.scene;
  const Place at = place_of(p.width, p.height, p.split, false);
  PixelMean& mean = means[threadIdx.x];
  mean = {};
  uint32_t rays = 0;
  if (at.inside) {
    const int end = p.samples * (at.group + 1) / p.split;
    int next = p.samples * at.group / p.split;
    LightProbabilitiesOf<float> probabilities;
    PathMachine path;
    bool is_first = true;  // ray of its path: the camera's
    // A lane whose path has ended starts the next at once: it does not wait for its warp.
    for (bool running = false; running || next < end;) {
      if (!running) {
        RayCone cone;
        Sampler sampler;
        const Ray ray = sample_ray(p, at, p.first_sample + next++, false, &cone, &sampler);
        if (!sees(ray)) {
          mean.add({});
          continue;
        }
        path.start(ray, cone, sampler, &probabilities);
        is_first = true;
      }
      RayHit hit;
      bool shadowed;
      bool found = p.tracer.trace_both(path.shadow(scene), path.ray(scene), &shadowed, &hit);
      if (is_first) found = clip_first(p, path.ray(scene), found, &hit);
      is_first = false;
      running = path.advance(scene, p.path, shadowed, found, hit);
      if (running) continue;
      mean.add(path.result());
      rays += path.result().rays;
    }
  }
  count_rays(p.film, rays);
  if (p.split > 1) {
    __syncthreads();
    if (at.group > 0) return;
    for (int k = 1; k < p.split; ++k) mean.merge(means[threadIdx.x + k * kWarp]);
  }
  if (at.inside) store_mean(p, at.pixel(p.width), mean);
}

}  // namespace
}  // namespace gloam::cuda

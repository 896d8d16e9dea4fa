// Kernel of LiDARs: a beam a thread.
#include "render/cuda/lidar/scan_kernels.h"
#include "render/kernel/lidar/lidar.h"

namespace gloam::cuda {
namespace {

constexpr int kBlock = 64;

/// Tracer as one function: a traversal for each place that traces would crowd the kernel.
struct CalledTracer {
  const DeviceScan& p;

  __device__ __noinline__ bool closest(const Ray& ray, bool active, bool, RayHit* hit) const {
    return active && p.tracer.trace(ray, false, hit);
  }
};

__global__ void __launch_bounds__(kBlock) scan_kernel(const __grid_constant__ DeviceScan p) {
  const uint32_t i = blockIdx.x * kBlock + threadIdx.x;
  if (i >= p.beams.size) return;
  const LidarBeam beam = p.beams[i];
  const LidarKey key{p.seed, p.scan, beam.id};
  const bool has_media = p.scene.has_media();
  LidarEchoes echoes;
  Backscatter soft(p.optics, key, &echoes);
  const int rays = p.optics.footprint_rays;
  for (int k = 0; k < rays; ++k) {
    const Vec3f d =
        rays > 1 ? footprint_direction<float>(p.optics, beam.d, p.footprint[k]) : beam.d;
    // Media hardly vary within a footprint: one ray measures their backscatter.
    trace_echoes<float>(
        p.scene, CalledTracer{p}, p.optics, beam_ray<float>(p.motions, d, beam.time), true,
        1.0f / static_cast<float>(rays), &echoes, has_media && k == 0 ? &soft : nullptr);
  }
  if (has_media) soft.finish();
  detect(p.optics, key, &echoes, p.returns + static_cast<size_t>(i) * p.optics.most_returns);
}

}  // namespace

void launch_scan(const DeviceScan& p, CUstream_st* stream) {
  if (p.beams.empty()) return;
  scan_kernel<<<(p.beams.size + kBlock - 1) / kBlock, kBlock, 0, stream>>>(p);
}

}  // namespace gloam::cuda

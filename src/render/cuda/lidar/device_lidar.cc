#include "render/cuda/lidar/device_lidar.h"

#include <algorithm>

namespace gloam::cuda {

LidarOptics DeviceLidar::put(const LidarOptics& optics, Parcel* parcel) {
  LidarOptics out = optics;
  std::vector<LidarParticles> particles(optics.particles.data,
                                        optics.particles.data + optics.particles.size);
  for (LidarParticles& set : particles) {
    set.classes = parcel->put(set.classes);
    set.cells = parcel->put(set.cells);
  }
  out.particles = parcel->put(particles);
  out.lidar_ratios = parcel->put(optics.lidar_ratios);
  out.hidden = parcel->put(optics.hidden);
  out.surfaces = parcel->put(optics.surfaces);
  return out;
}

void DeviceLidar::scan(const SceneView& scene, const BvhTracer& tracer, const LidarView& view,
                       cudaStream_t stream, std::span<LidarReturn> returns) {
  DeviceScan scan;
  scan.scene = scene;
  scan.tracer = tracer;
  scan.seed = view.seed;
  scan.scan = view.scan;
  const auto footprint = footprint_points(view.optics.footprint_rays);
  std::copy(footprint.begin(), footprint.end(), scan.footprint);
  const auto fill = [&](Parcel* parcel) {
    scan.optics = put(view.optics, parcel);
    scan.motions = parcel->put(DeviceSpan<const LidarMotion>{
        view.motions.data(), static_cast<uint32_t>(view.motions.size())});
    scan.beams = parcel->put(
        DeviceSpan<const LidarBeam>{view.beams.data(), static_cast<uint32_t>(view.beams.size())});
  };
  place_.send(fill, &staging_, stream);
  scan.returns = returns_.reserve_of<LidarReturn>(returns.size());
  launch_scan(scan, stream);
  check(cudaGetLastError(), "cannot launch a CUDA kernel");
  auto* host = reinterpret_cast<LidarReturn*>(host_.reserve(returns.size_bytes()));
  check(cudaMemcpyAsync(host, scan.returns, returns.size_bytes(), cudaMemcpyDeviceToHost, stream),
        "cannot copy a scan from the GPU");
  check(cudaStreamSynchronize(stream), "a CUDA kernel failed");
  std::copy(host, host + returns.size(), returns.begin());
}

}  // namespace gloam::cuda

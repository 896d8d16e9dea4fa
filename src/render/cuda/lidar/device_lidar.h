#pragma once
// LiDAR scans on the card.

#include <span>

#include "render/cuda/lidar/scan_kernels.h"
#include "render/cuda/parcel.h"
#include "render/lidar_view.h"

namespace gloam::cuda {

class DeviceLidar {
 public:
  /// Scans a scene that is on the card; returns when `returns` are filled.
  void scan(const SceneView& scene, const BvhTracer& tracer, const LidarView& view,
            cudaStream_t stream, std::span<LidarReturn> returns);

 private:
  static LidarOptics put(const LidarOptics& optics, Parcel* parcel);

  ParcelPlace place_;
  PinnedBuffer staging_, host_;
  DeviceBuffer returns_;
};

}  // namespace gloam::cuda

#pragma once
// Interface of the host to the LiDAR's kernel.

#include "render/kernel/lidar/lidar_detect.h"
#include "render/kernel/lidar/lidar_motion.h"
#include "render/kernel/trace/bvh_tracer.h"

struct CUstream_st;

namespace gloam {

/// One scan of one world; pointers are the device's.
struct DeviceScan {
  SceneView scene;
  BvhTracer tracer;
  LidarOptics optics;
  Vec2f footprint[kMostFootprintRays];
  DeviceSpan<const LidarMotion> motions;
  DeviceSpan<const LidarBeam> beams;
  uint64_t seed = 1, scan = 0;
  LidarReturn* returns = nullptr;  ///< optics.most_returns of each beam
};

namespace cuda {

void launch_scan(const DeviceScan& scan, CUstream_st* stream);

}  // namespace cuda
}  // namespace gloam

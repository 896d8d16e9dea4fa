#pragma once
// One LiDAR's beams in one window of time, as the renderer takes them.

#include <array>
#include <cstdint>
#include <span>

#include "render/kernel/lidar/lidar_detect.h"
#include "render/kernel/lidar/lidar_motion.h"

namespace gloam {

class RenderTurns;

/// Beams that follow each other are traced together: neighbours in space should be neighbours here.
struct LidarView {
  std::span<const LidarMotion> motions;  ///< between the renderer's keys, one less than they
  LidarOptics optics;
  uint64_t seed = 1;
  uint64_t scan = 0;  ///< draws are keyed (seed, scan, beam)
  std::span<const LidarBeam> beams;
  RenderTurns* turns = nullptr;  ///< as RenderSettings::turns
};

/// Even motion from one pose to another; L turns by less than half a turn.
LidarMotion make_lidar_motion(const Affine3f& X_WL_open, const Affine3f& X_WL_close);

/// Rays of a footprint, in half angles at 1/e²: as many as asked for, of the same share of a
/// Gaussian beam each; a single one is its axis.
std::array<Vec2f, kMostFootprintRays> footprint_points(int rays);

}  // namespace gloam

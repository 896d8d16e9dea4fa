#pragma once
// A LiDAR: the poses of one scan in, one LidarScan out, a pure function of (World, seed, LiDAR,
// index of the scan, poses). Between two of the instants that poses are given for everything moves
// evenly, sensor and bodies alike, and each beam has its own time.

#include <memory>
#include <span>

#include "gloam/sensor.h"
#include "render/lidar_view.h"
#include "render/renderer.h"
#include "render/turns.h"
#include "sensors/lidar/lidar_particle_table.h"
#include "sensors/lidar/lidar_pattern.h"
#include "world/sensors/authored_lidar.h"

namespace gloam {

class LidarSensor {
 public:
  /// `rendered` must outlive the sensor. Errors: those of make_lidar_model(),
  /// a [[lidar.surface]] of no material.
  static Result<std::unique_ptr<LidarSensor>> create(const RenderDescription& rendered,
                                                     const LidarDescription& lidar, uint64_t seed);

  /// The scan between the first and the last of `keys`, two or more instants in order.
  /// Has a turn of `turns` while the shared renderer works.
  std::shared_ptr<const LidarScan> scan(Renderer& renderer, RenderTurns& turns,
                                        std::span<const PoseFrame> keys, int64_t index);

  /// Wall time spent waiting for turns at the renderer, over all scans [s].
  double waited() const { return use_.waited; }
  const LidarModel& model() const { return model_; }
  const LidarOptions& options() const { return lidar_.options; }

 private:
  LidarSensor(const RenderDescription& rendered, const LidarDescription& lidar, LidarModel model,
              uint64_t seed);
  Status find_surfaces();
  void plan(std::span<const PoseFrame> keys, int64_t index);
  void write_points(std::span<const Affine3f> X_WL, LidarScan* scan) const;
  /// A return of a firing, and the point that it becomes.
  struct PlacedReturn {
    size_t firing, number, point;
  };
  void write_point(const Affine3f& end, const PlacedReturn& at, LidarScan* scan) const;
  void add_truth(LidarScan* scan) const;

  const RenderDescription& rendered_;
  const LidarDescription lidar_;
  const LidarModel model_;
  const uint64_t seed_;
  Vec3 origin_;                                      ///< RenderDescription::origin
  std::vector<float> lidar_ratios_;                  ///< by volume [sr]
  std::vector<LidarParticleTable> particle_tables_;  ///< by volume; empty = none has any
  std::vector<LidarParticles> particles_;            ///< views of these
  std::vector<uint8_t> hidden_;                      ///< by instance; empty = none
  std::vector<LidarSurface> surfaces_;               ///< by instance; empty = as their colours say
  std::vector<LidarFiring> firings_;
  std::vector<float> cuts_;  ///< times of the keys, 0 … 1
  /// In the order in which they are traced. Their times count every stretch as equally long.
  std::vector<LidarBeam> beams_;
  std::vector<uint32_t> place_;       ///< in beams_, by firing
  std::vector<LidarMotion> motions_;  ///< motions of the stretches between keys
  std::vector<LidarReturn> returns_;  ///< by beams_
  RenderUse use_;
};

}  // namespace gloam

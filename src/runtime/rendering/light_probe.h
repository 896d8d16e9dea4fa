#pragma once
// Illuminance at a place, without a camera there.

#include <memory>
#include <vector>

#include "runtime/rendering/shared_renderer.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {

class LightProbe {
 public:
  static Result<std::unique_ptr<LightProbe>> make(std::shared_ptr<SharedRenderer> shared);

  /// Illuminance [lx] of level surfaces at places at the snapshot's instant; none where MuJoCo
  /// refuses its poses.
  std::vector<double> illuminance(const Snapshot& snapshot, const std::vector<Vec3>& places);

 private:
  explicit LightProbe(std::shared_ptr<SharedRenderer> shared) : shared_(std::move(shared)) {}

  std::shared_ptr<SharedRenderer> shared_;
  std::unique_ptr<PoseSolver> solver_;
  PoseFrame poses_;
};

}  // namespace gloam

#pragma once
// How bright it is at a place, without a camera there.

#include <memory>

#include "runtime/shared_renderer.h"
#include "sim/pose_solver.h"

namespace gloam {

class LightProbe {
 public:
  static Result<std::unique_ptr<LightProbe>> make(std::shared_ptr<SharedRenderer> shared);

  /// Illuminance [lx] of a level surface at p_W at the snapshot's instant; nothing where MuJoCo
  /// refuses its poses.
  double illuminance(const Snapshot& snapshot, Vec3f p_W);

 private:
  explicit LightProbe(std::shared_ptr<SharedRenderer> shared) : shared_(std::move(shared)) {}

  std::shared_ptr<SharedRenderer> shared_;
  std::unique_ptr<PoseSolver> solver_;
  PoseFrame poses_;
};

}  // namespace gloam

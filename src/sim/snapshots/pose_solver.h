#pragma once
// Snapshot -> poses of everything visible at that very instant, on the consumer's thread. (After
// mj_step the poses in mjData are those before the step, so they are never copied from there.)

#include "instant/pose_frame.h"
#include "sim/loop/stepper.h"
#include "world/shapes/deformable_layout.h"

namespace gloam {

/// Used by one thread at a time; any number of PoseSolvers may share a World.
class PoseSolver {
 public:
  static Result<std::unique_ptr<PoseSolver>> create(std::shared_ptr<const CompiledWorld> world);

  /// Fills `frame`; its buffers are used again. The Snapshot is of the same World. Error: MuJoCo's.
  Status solve(const Snapshot& snapshot, PoseFrame& frame);
  /// Poses of bodies, cameras and lights alone, for whoever draws nothing: the vertices of skins,
  /// flexes and waters, which cost a hundred times as much, are not made.
  Status solve_bodies(const Snapshot& snapshot, PoseFrame& frame);

  /// Number of times that vertices were made.
  int64_t meshed() const { return meshed_; }

  const std::shared_ptr<const CompiledWorld>& world() const { return world_; }
  const DeformableLayout& layout() const { return layout_; }

 private:
  PoseSolver() = default;
  const mjModel& model() const { return own_model_ ? *own_model_ : *world_->model; }
  Status follow_live_fields(const std::shared_ptr<const LiveFields>& live);
  void own_the_model();
  void fill_poses(PoseFrame& frame) const;
  void fill_vertices(const LiveFields* live, PoseFrame& frame);
  void fill_live(const LiveFields* live, PoseFrame& frame);

  std::shared_ptr<const CompiledWorld> world_;
  ModelPtr own_model_;  // only where the World's own will not do: other masses, or sleep
  DataPtr data_, scratch_;
  DeformableLayout layout_;
  std::vector<double> masses_;   // in own_model_; empty = the World's
  std::vector<double> gravity_;  // scratch to read live fields into
  std::vector<float> active_;
  std::vector<float> heights_;  // scratch for surfaces
  int64_t meshed_ = 0;
};

}  // namespace gloam

#include "runtime/light_probe.h"

namespace gloam {

Result<std::unique_ptr<LightProbe>> LightProbe::make(std::shared_ptr<SharedRenderer> shared) {
  std::unique_ptr<LightProbe> probe(new LightProbe(std::move(shared)));
  GLOAM_TRY(probe->solver_, PoseSolver::create(probe->shared_->world));
  return probe;
}

double LightProbe::illuminance(const Snapshot& snapshot, Vec3f p_W) {
  if (!solver_->solve(snapshot, poses_).ok()) return 0;
  const std::lock_guard lock(shared_->mutex);
  shared_->renderer->update(poses_, poses_, poses_);
  return static_cast<double>(shared_->renderer->illuminance(p_W, {0, 0, 1}));
}

}  // namespace gloam

#include "runtime/rendering/light_probe.h"

#include "geometry/mesh/single.h"

namespace gloam {

Result<std::unique_ptr<LightProbe>> LightProbe::make(std::shared_ptr<SharedRenderer> shared) {
  std::unique_ptr<LightProbe> probe(new LightProbe(std::move(shared)));
  GLOAM_TRY(probe->solver_, PoseSolver::create(probe->shared_->world));
  return probe;
}

std::vector<double> LightProbe::illuminance(const Snapshot& snapshot,
                                            const std::vector<Vec3>& places) {
  std::vector<double> out(places.size());
  if (!solver_->solve(snapshot, poses_).ok()) return out;
  const std::lock_guard lock(shared_->turns);
  shared_->renderer->update(poses_, poses_, poses_);
  for (size_t i = 0; i < out.size(); ++i) {
    const Vec3f p = to_vec3f(from_origin(places[i], shared_->description.origin));
    out[i] = static_cast<double>(shared_->renderer->illuminance(p, {0, 0, 1}));
  }
  return out;
}

}  // namespace gloam

#include "sensors/probe/probe.h"

#include "geometry/mesh/single.h"
#include "world/world.h"

namespace gloam {

Result<ProbeRenderer> ProbeSetup::renderer() const {
  if (sources.renderer) return sources.renderer(world);
  return Error{ErrorKind::kUsage, "it requires a renderer, but there is none"};
}

void ProbeInstant::follow(const Snapshot& snapshot) {
  snapshot_ = &snapshot;
  has_poses_ = has_contacts_ = false;
}

Result<const PoseFrame*> ProbeInstant::poses() {
  if (solver_ == nullptr) {
    GLOAM_TRY(solver_, PoseSolver::create(world_));
  }
  if (!has_poses_) GLOAM_TRY_STATUS(solver_->solve(*snapshot_, poses_));
  has_poses_ = true;
  return &std::as_const(poses_);
}

Result<const std::vector<ContactState>*> ProbeInstant::contacts() {
  if (!has_contacts_) {
    GLOAM_TRY_STATUS(instant_.solve(*snapshot_));
    instant_.contacts(&contacts_);
  }
  has_contacts_ = true;
  return &std::as_const(contacts_);
}

Result<Vec3> ProbeInstant::turned(int body, const Vec3& v) {
  if (body == 0) return v;
  GLOAM_TRY(const PoseFrame* const poses, this->poses());
  const double* R = poses->body_R.data() + 9 * static_cast<size_t>(body);
  return Vec3{R[0] * v.x + R[1] * v.y + R[2] * v.z, R[3] * v.x + R[4] * v.y + R[5] * v.z,
              R[6] * v.x + R[7] * v.y + R[8] * v.z};
}

Result<Vec3> ProbeInstant::place(const ProbeDescription& probe) {
  if (probe.body == 0) return probe.p_B;
  GLOAM_TRY(const Vec3 away, turned(probe.body, probe.p_B));
  const double* p = poses_.body_p.data() + 3 * static_cast<size_t>(probe.body);
  return in_world(Vec3{p[0] + away.x, p[1] + away.y, p[2] + away.z}, world_->render_origin);
}

Result<Vec3> ProbeInstant::normal(const ProbeDescription& probe) {
  return turned(probe.body, probe.n_B);
}

}  // namespace gloam

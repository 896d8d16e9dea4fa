#include "control/frame_dynamics.h"

#include "world/model_memory.h"

namespace gloam {

FrameDynamics::FrameDynamics(const mjModel& model, const ik::FrameId& frame, std::vector<int> dofs)
    : model_(&model), frame_(frame), dofs_(std::move(dofs)), data_(make_data(model)) {
  const auto nv = static_cast<Eigen::Index>(model.nv);
  const auto n = static_cast<Eigen::Index>(dofs_.size());
  M.setZero(n, n);
  J.setZero(6, n);
  bias.setZero(n);
  velocity.setZero();
  drift.setZero();
  jacobian_.setZero(6, nv);
  bias_.setZero(nv);
  unit_.setZero(nv);
  column_.setZero(nv);
}

FrameDynamics::FrameDynamics(const FrameDynamics& other)
    : FrameDynamics(*other.model_, other.frame_, other.dofs_) {}

void FrameDynamics::update(const mjModel& model, const mjData& state) {
  mjData* const d = data_.get();
  const int nv = static_cast<int>(model.nv);
  mju_copy(d->qpos, state.qpos, static_cast<int>(model.nq));
  mju_copy(d->qvel, state.qvel, nv);
  mju_copy(d->mocap_pos, state.mocap_pos, static_cast<int>(3 * model.nmocap));
  mju_copy(d->mocap_quat, state.mocap_quat, static_cast<int>(4 * model.nmocap));
  mj_kinematics(&model, d);
  mj_comPos(&model, d);
  mj_makeM(&model, d);
  mj_comVel(&model, d);
  mj_rne(&model, d, 0, bias_.data());
  if (model.ngravcomp > 0) {  // MuJoCo itself adds these torques
    mj_passive(&model, d);
    bias_ -= Eigen::Map<const ik::VectorXd>(d->qfrc_gravcomp, nv);
  }

  X_WF = ik::pose_of(*d, frame_);
  const int body = frame_.body(model);
  const Eigen::Map<const ik::VectorXd> v(d->qvel, nv);
  double* const rows = jacobian_.data();
  mj_jacDot(&model, d, rows, rows + 3 * nv, X_WF.p.data(), body);
  drift = jacobian_.lazyProduct(v);
  mj_jac(&model, d, rows, rows + 3 * nv, X_WF.p.data(), body);
  velocity = jacobian_.lazyProduct(v);

  for (size_t i = 0; i < dofs_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    J.col(column) = jacobian_.col(dofs_[i]);
    bias[column] = bias_[dofs_[i]];
    unit_[dofs_[i]] = 1;
    mj_mulM(&model, d, column_.data(), unit_.data());
    unit_[dofs_[i]] = 0;
    for (size_t j = 0; j < dofs_.size(); ++j)
      M(static_cast<Eigen::Index>(j), column) = column_[dofs_[j]];
  }
}

}  // namespace gloam

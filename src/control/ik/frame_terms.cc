#include "control/ik/frame_terms.h"

#include "control/ik/lie.h"
#include "control/ik/ranges.h"

namespace gloam::ik {
namespace {

template <class Options>
Result<TwistGains> twist_gains(const Options& o) {
  GLOAM_TRY_STATUS(check_gains(o.gain, o.lm_damping));
  TwistGains gains{{}, o.gain, o.lm_damping};
  gains.weight << o.position_cost.x, o.position_cost.y, o.position_cost.z, o.orientation_cost.x,
      o.orientation_cost.y, o.orientation_cost.z;
  GLOAM_TRY_STATUS(check_costs({gains.weight.data(), 6}));
  return gains;
}

}  // namespace

Result<FrameTerm> FrameTerm::create(const Kinematics& at, const FrameTask& options) {
  FrameTerm term;
  GLOAM_TRY(term.frame_, find_frame(at.model(), options.frame));
  GLOAM_TRY(term.gains_, twist_gains(options));
  term.J_.resize(6, at.size());
  return term;
}

Status FrameTerm::set_target(const Pose& X_WT) {
  GLOAM_TRY_STATUS(check_pose(X_WT));
  X_WT_ = to_transform(X_WT);
  return {};
}

void FrameTerm::add_to(Objective& objective, Kinematics& at) {
  const Transform X_WB = at.pose(frame_);
  error_ = log(inverse(X_WB) * *X_WT_);
  at.body_jacobian(frame_, J_);
  const Matrix6d derivative = -log_derivative(inverse(*X_WT_) * X_WB);
  for (Eigen::Index i = 0; i < J_.cols(); ++i) {
    const Vector6d column = J_.col(i);
    J_.col(i) = derivative * column;
  }
  objective.add(J_, gains_.weight, error_, gains_.gain, gains_.lm_damping);
}

Result<RelativeFrameTerm> RelativeFrameTerm::create(const Kinematics& at,
                                                    const RelativeFrameTask& options) {
  RelativeFrameTerm term;
  GLOAM_TRY(term.frame_, find_frame(at.model(), options.frame));
  GLOAM_TRY(term.root_, find_frame(at.model(), options.root));
  GLOAM_TRY(term.gains_, twist_gains(options));
  term.J_.resize(6, at.size());
  term.J_root_.resize(6, at.size());
  return term;
}

Status RelativeFrameTerm::set_target(const Pose& X_RT) {
  GLOAM_TRY_STATUS(check_pose(X_RT));
  X_RT_ = to_transform(X_RT);
  return {};
}

void RelativeFrameTerm::add_to(Objective& objective, Kinematics& at) {
  const Transform X_RB = inverse(at.pose(root_)) * at.pose(frame_);
  const Transform X_TB = inverse(*X_RT_) * X_RB;
  error_ = log(X_TB);
  at.body_jacobian(frame_, J_);
  at.body_jacobian(root_, J_root_);
  const Matrix6d to_frame = adjoint(inverse(X_RB)), derivative = log_derivative(X_TB);
  for (Eigen::Index i = 0; i < J_.cols(); ++i) {
    const Vector6d relative = J_.col(i) - to_frame * J_root_.col(i);
    J_.col(i) = derivative * relative;
  }
  objective.add(J_, gains_.weight, error_, gains_.gain, gains_.lm_damping);
}

}  // namespace gloam::ik

#include "control/ik/joint_terms.h"

#include <fmt/format.h>

#include "control/ik/ranges.h"

namespace gloam::ik {
namespace {

bool is_free(const mjModel& model, int dof) {
  return model.jnt_type[model.dof_jntid[dof]] == mjJNT_FREE;
}

// One cost for all degrees of freedom or one for each: the weights of those that may move.
Result<VectorXd> joint_weights(const Kinematics& at, const std::vector<double>& cost) {
  GLOAM_TRY_STATUS(check_costs(cost));
  const mjModel& model = at.model();
  if (cost.size() != 1 && cost.size() != static_cast<size_t>(model.nv)) {
    return Error{ErrorKind::kInput,
                 fmt::format("the cost of a task has {} values, but the model has {} degrees of "
                             "freedom",
                             cost.size(), model.nv),
                 {},
                 "give one value, or one per degree of freedom"};
  }
  VectorXd weight(at.size());
  for (int i = 0; i < at.size(); ++i) {
    const int dof = at.dofs()[i];
    weight[i] = is_free(model, dof) ? 0 : cost[cost.size() == 1 ? 0 : static_cast<size_t>(dof)];
  }
  return weight;
}

}  // namespace

Result<PostureTerm> PostureTerm::create(const Kinematics& at, const PostureTask& options) {
  GLOAM_TRY_STATUS(check_gains(options.gain, options.lm_damping));
  PostureTerm term;
  GLOAM_TRY(term.weight_, joint_weights(at, options.cost));
  term.gain_ = options.gain;
  term.lm_damping_ = options.lm_damping;
  const mjModel& model = at.model();
  term.nq_ = static_cast<int>(model.nq);
  term.error_.resize(static_cast<size_t>(model.nv));
  for (int dof = 0; dof < model.nv; ++dof) term.free_.push_back(is_free(model, dof));
  term.target_.reserve(static_cast<size_t>(model.nq));
  return term;
}

Status PostureTerm::set_target(std::span<const double> qpos) {
  GLOAM_TRY_STATUS(check_finite(qpos, "the target of a posture task"));
  if (qpos.size() != static_cast<size_t>(nq_)) {
    return Error{ErrorKind::kInput,
                 fmt::format("the target of a posture task has {} values, but the model has {} "
                             "coordinates",
                             qpos.size(), nq_)};
  }
  target_.assign(qpos.begin(), qpos.end());
  return {};
}

void PostureTerm::add_to(Objective& objective, Kinematics& at) {
  mj_differentiatePos(&at.model(), error_.data(), 1, target_.data(), at.data().qpos);
  for (size_t dof = 0; dof < error_.size(); ++dof)
    if (free_[dof]) error_[dof] = 0;
  double square = 0;
  for (int i = 0; i < at.size(); ++i) {
    const double w = weight_[i], weighted = -gain_ * w * error_[at.dofs()[i]];
    objective.H(i, i) += w * w;
    objective.c[i] -= w * weighted;
    square += weighted * weighted;
  }
  objective.H.diagonal().array() += lm_damping_ * square;
}

Result<DampingTerm> DampingTerm::create(const Kinematics& at, const DampingTask& options) {
  DampingTerm term;
  GLOAM_TRY(term.weight_, joint_weights(at, options.cost));
  term.error_.resize(static_cast<size_t>(at.model().nv));
  return term;
}

void DampingTerm::add_to(Objective& objective, Kinematics&) {
  objective.H.diagonal() += weight_.cwiseAbs2();
}

}  // namespace gloam::ik

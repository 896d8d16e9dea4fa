#include "control/ik/com_term.h"

#include "control/ik/ranges.h"

namespace gloam::ik {

Result<ComTerm> ComTerm::create(const Kinematics& at, const ComTask& options) {
  ComTerm term;
  if (options.body.empty() && at.model().nbody < 2)
    return refuse_value("a model without bodies has no centre of mass");
  if (!options.body.empty()) {
    GLOAM_TRY(term.body_, find_element(at.model(), mjOBJ_BODY, "body", options.body));
  }
  if (!(at.model().body_subtreemass[term.body_] > 0))
    return refuse_value("the body of a centre-of-mass task has no mass");
  GLOAM_TRY_STATUS(check_gains(options.gain, options.lm_damping));
  term.weight_ = {options.cost.x, options.cost.y, options.cost.z};
  GLOAM_TRY_STATUS(check_costs({term.weight_.data(), 3}));
  term.gain_ = options.gain;
  term.lm_damping_ = options.lm_damping;
  term.J_.resize(3, at.size());
  return term;
}

Status ComTerm::set_target(std::span<const double> com_W) {
  if (com_W.size() != 3)
    return refuse_value("the target of a centre-of-mass task has three coordinates");
  GLOAM_TRY_STATUS(check_finite(com_W, "the target of a centre-of-mass task"));
  target_W_ = Vector3d(com_W[0], com_W[1], com_W[2]);
  return {};
}

void ComTerm::add_to(Objective& objective, Kinematics& at) {
  error_ = Eigen::Map<const Vector3d>(at.data().subtree_com + 3 * body_) - *target_W_;
  at.com_jacobian(body_, J_);
  objective.add(J_, weight_, error_, gain_, lm_damping_);
}

}  // namespace gloam::ik

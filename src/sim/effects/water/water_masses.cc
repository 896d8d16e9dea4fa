// Places of the added mass of water during a step.

#include <algorithm>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/water/water_forces.h"

namespace gloam {

void WaterForces::carry_nothing(mjModel& model) {
  std::copy_n(model.dof_armature, armature_.size(), armature_.begin());
  std::copy_n(model.dof_M0, inertia_.size(), inertia_.begin());
  model_armature_ = model.dof_armature;
  model_inertia_ = model.dof_M0;
  model.dof_armature = armature_.data();
  model.dof_M0 = inertia_.data();
}

void WaterForces::add_masses(const mjModel& m, mjData& d) const {
  for (int tree = 0; tree < static_cast<int>(m.ntree); ++tree) {
    bool changed = false;
    const int first = m.tree_dofadr[tree];
    for (int dof = first; dof < first + m.tree_dofnum[tree]; ++dof) {
      const double more = armature_[static_cast<size_t>(dof)] - model_armature_[dof];
      d.M[m.M_rowadr[dof] + m.M_rownnz[dof] - 1] += more;
      changed |= more > 0;
    }
    if (changed) factor_tree(m, d, tree);
  }
}

void WaterForces::end(mjModel& model) {
  if (model_armature_ == nullptr) return;
  model.dof_armature = model_armature_;
  model.dof_M0 = model_inertia_;
  model_armature_ = model_inertia_ = nullptr;
}

}  // namespace gloam

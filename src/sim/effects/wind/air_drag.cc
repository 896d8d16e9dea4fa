#include "sim/effects/wind/air_drag.h"

#include <algorithm>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/wind/wind.h"

namespace gloam {

AirDrag::AirDrag(const mjModel& m) : parts_(drag_parts(m)) {
  std::vector<int> row_of(static_cast<size_t>(m.nbody), -1);
  size_t next = 0;
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    const int parent = row_of[static_cast<size_t>(m.body_parentid[b])];
    if (parent < 0 && m.body_dofnum[b] == 0) continue;
    row_of[static_cast<size_t>(b)] = static_cast<int>(bodies_.size());
    while (next < parts_.size() && parts_[next].body <= b) ++next;
    bodies_.push_back({b, parent, next});
  }
  wrenches_.resize(6 * bodies_.size());
  for (int dof = 0; dof < static_cast<int>(m.nv); ++dof)
    row_of_dof_.push_back(row_of[static_cast<size_t>(m.dof_bodyid[dof])]);
}

void AirDrag::push(const mjModel& m, mjData& d) {
  std::fill(wrenches_.begin(), wrenches_.end(), 0.0);
  size_t part = 0;
  for (size_t n = 0; n < bodies_.size(); ++n) {
    const double* twist = d.cvel + 6 * bodies_[n].id;
    const double* centre = d.subtree_com + 3 * m.body_rootid[bodies_[n].id];
    double* to = wrenches_.data() + 6 * n;
    for (; part < bodies_[n].parts; ++part) {
      const DragPart& it = parts_[part];
      double arm[3], v[3], force[3] = {}, moment[3];
      it.place(d, arm);
      for (int a = 0; a < 3; ++a) arm[a] -= centre[a];
      cross3(twist, arm, v);
      for (int a = 0; a < 3; ++a) v[a] += twist[3 + a] - m.opt.wind[a];
      it.add_force(d, v, kAir, m.opt.timestep, force);
      it.add_torque(d, twist, kAir, m.opt.timestep, to);
      cross3(arm, force, moment);
      for (int i = 0; i < 3; ++i) to[i] += moment[i], to[3 + i] += force[i];
    }
  }
  for (size_t n = bodies_.size(); n-- > 0;) {
    if (bodies_[n].parent < 0) continue;
    double* to = wrenches_.data() + 6 * bodies_[n].parent;
    for (size_t i = 0; i < 6; ++i) to[i] += wrenches_[6 * n + i];
  }
  for (size_t dof = 0; dof < row_of_dof_.size(); ++dof) {
    const double *axis = d.cdof + 6 * dof, *wrench = wrenches_.data() + 6 * row_of_dof_[dof];
    d.qfrc_applied[dof] += dot3(axis, wrench) + dot3(axis + 3, wrench + 3);
  }
}

}  // namespace gloam

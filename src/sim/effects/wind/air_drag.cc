#include "sim/effects/wind/air_drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/effects/bodies/body_forces.h"

namespace gloam {

bool AirDrag::can_be(const mjModel& m) {
  constexpr int kNoPassive = mjDSBL_SPRING | mjDSBL_DAMPER;  // with both of them no fluid either
  if (m.opt.integrator != mjINT_EULER || (m.opt.disableflags & kNoPassive) == kNoPassive)
    return false;
  for (int geom = 0; geom < static_cast<int>(m.ngeom); ++geom)
    if (m.geom_fluid[mjNFLUID * geom] > 0) return false;
  return true;
}

void AirDrag::measure(const mjModel& m) {
  const double rho = m.opt.density, mu = m.opt.viscosity, pi = std::numbers::pi;
  bodies_.clear();
  std::vector<int> row_of(static_cast<size_t>(m.nbody), -1);
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) {
    const int parent = row_of[static_cast<size_t>(m.body_parentid[b])];
    if (parent < 0 && m.body_dofnum[b] == 0) continue;
    row_of[static_cast<size_t>(b)] = static_cast<int>(bodies_.size());
    Body& body = bodies_.emplace_back();
    body.id = b, body.parent = parent;
    if (m.body_mass[b] < mjMINVAL) continue;
    const mjtNum* inertia = m.body_inertia + 3 * b;
    double edge[3];  // [m]
    for (int a = 0; a < 3; ++a) {
      const double square = inertia[(a + 1) % 3] + inertia[(a + 2) % 3] - inertia[a];
      edge[a] = std::sqrt(std::max(square, double{mjMINVAL}) / m.body_mass[b] * 6);
    }
    const double mean = (edge[0] + edge[1] + edge[2]) / 3;
    body.viscous = 3 * pi * mean * mu;
    body.viscous_spin = pi * mean * mean * mean * mu;
    for (int a = 0; a < 3; ++a) {
      const double y = edge[(a + 1) % 3], z = edge[(a + 2) % 3];
      body.drag[a] = rho / 2 * y * z;
      body.spin[a] = rho / 64 * edge[a] * (y * y * y * y + z * z * z * z);
    }
  }
  wrenches_.resize(6 * bodies_.size());
  row_of_dof_.clear();
  for (int dof = 0; dof < static_cast<int>(m.nv); ++dof)
    row_of_dof_.push_back(row_of[static_cast<size_t>(m.dof_bodyid[dof])]);
}

void AirDrag::push(const mjModel& m, mjData& d) {
  for (size_t n = 0; n < bodies_.size(); ++n) {
    const Body& body = bodies_[n];
    const double *R = d.ximat + 9 * body.id, *p = d.xipos + 3 * body.id,
                 *twist = d.cvel + 6 * body.id;
    const double* centre = d.subtree_com + 3 * m.body_rootid[body.id];
    const double arm[3] = {p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]};
    double v[3], force[3] = {}, torque[3] = {}, moment[3];
    cross3(twist, arm, v);
    for (int a = 0; a < 3; ++a) v[a] += twist[3 + a] - m.opt.wind[a];
    for (int a = 0; a < 3; ++a) {
      const double u = R[a] * v[0] + R[3 + a] * v[1] + R[6 + a] * v[2];
      const double w = R[a] * twist[0] + R[3 + a] * twist[1] + R[6 + a] * twist[2];
      const double f = -(body.viscous + body.drag[a] * std::abs(u)) * u;
      const double t = -(body.viscous_spin + body.spin[a] * std::abs(w)) * w;
      for (int i = 0; i < 3; ++i) force[i] += R[3 * i + a] * f, torque[i] += R[3 * i + a] * t;
    }
    cross3(arm, force, moment);
    double* to = wrenches_.data() + 6 * n;
    for (int i = 0; i < 3; ++i) to[i] = torque[i] + moment[i], to[3 + i] = force[i];
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

#include "sim/effects/bodies/body_forces.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

void add_scaled6(const double* x, double scale, double* to) {
  for (int i = 0; i < 6; ++i) to[i] += scale * x[i];
}

}  // namespace

void edges_around(const double* R, const double* half, double* out) {
  for (int a = 0; a < 3; ++a) {
    out[a] = std::abs(R[3 * a]) * half[0] + std::abs(R[3 * a + 1]) * half[1] +
             std::abs(R[3 * a + 2]) * half[2];
  }
}

int last_dof(const mjModel& m, int body) {
  while (body > 0 && m.body_dofnum[body] == 0) body = m.body_parentid[body];
  return body > 0 ? m.body_dofadr[body] + m.body_dofnum[body] - 1 : -1;
}

void velocity_at(const mjModel& m, const mjData& d, int body, const double* point, double* v) {
  const double* twist = d.cvel + 6 * body;
  double arm[3];
  mju_sub3(arm, point, d.subtree_com + 3 * m.body_rootid[body]);
  cross3(twist, arm, v);
  mju_addTo3(v, twist + 3);
}

void add_wrench(const mjModel& m, mjData& d, int body, const double* force, const double* torque,
                const double* point) {
  double arm[3], moment[3];
  mju_sub3(arm, point, d.subtree_com + 3 * m.body_rootid[body]);
  cross3(arm, force, moment);
  mju_addTo3(moment, torque);
  for (int dof = last_dof(m, body); dof >= 0; dof = m.dof_parentid[dof]) {
    const double* axis = d.cdof + 6 * dof;  // turn, then shift, about the tree's centre of mass
    d.qfrc_applied[dof] += dot3(axis, moment) + dot3(axis + 3, force);
  }
}

// Featherstone 2008, "Rigid Body Dynamics Algorithms", table 6.3; rows are those of dofs above.
void factor_tree(const mjModel& m, mjData& d, int tree) {
  const int first = m.tree_dofadr[tree], last = first + m.tree_dofnum[tree] - 1;
  const int begin = m.M_rowadr[first], end = m.M_rowadr[last] + m.M_rownnz[last];
  std::copy(d.M + begin, d.M + end, d.qLD + begin);
  for (int dof = last; dof >= first; --dof) {
    double* row = d.qLD + m.M_rowadr[dof];
    const int above = m.M_rownnz[dof] - 1;
    const double inverse = 1 / row[above];
    d.qLDiagInv[dof] = inverse;
    for (int k = above - 1; k >= 0; --k) {
      double* to = d.qLD + m.M_rowadr[m.M_colind[m.M_rowadr[dof] + k]];
      const double share = row[k] * inverse;
      for (int i = 0; i <= k; ++i) to[i] -= share * row[i];
      row[k] = share;
    }
  }
}

ResponseSolver::ResponseSolver(const mjModel& m)
    : columns_(static_cast<size_t>(m.nv) * 6), by_dof_(static_cast<size_t>(m.nv)) {
  chain_.reserve(static_cast<size_t>(m.nv));
}

// With M = L' D L (Featherstone 2008, "Rigid Body Dynamics Algorithms", chapter 6) only the rows of
// L of the chain itself matter: J M^-1 J' = (L^-T J')' D^-1 (L^-T J').
BodyResponse ResponseSolver::solve(const mjModel& m, const mjData& d, int body, const double* point,
                                   std::span<const double> less) {
  BodyResponse out;
  const int last = last_dof(m, body);
  double arm[3];
  mju_sub3(arm, point, d.subtree_com + 3 * m.body_rootid[body]);
  size_t n = 0;
  for (int dof = last; dof >= 0; dof = m.dof_parentid[dof], ++n) {
    const double* axis = d.cdof + 6 * dof;
    double* column = columns_.data() + 6 * dof;
    cross3(axis, arm, column);
    for (int a = 0; a < 3; ++a) column[a] += axis[3 + a], column[3 + a] = axis[a];
    add_scaled6(column, d.qvel[dof], out.velocity);
    add_scaled6(column, d.qacc_warmstart[dof] - (n < less.size() ? less[n] : 0), out.acceleration);
  }
  for (int dof = last; dof >= 0; dof = m.dof_parentid[dof]) {
    const double* column = columns_.data() + 6 * dof;
    const int row = m.M_rowadr[dof];
    for (int k = 0; k + 1 < m.M_rownnz[dof]; ++k)
      add_scaled6(column, -d.qLD[row + k], columns_.data() + 6 * m.M_colind[row + k]);
    for (int i = 0; i < 6; ++i)
      add_scaled6(column, d.qLDiagInv[dof] * column[i], out.inverse + 6 * i);
  }
  return out;
}

// L^-1 D^-1 of what solve() has made of the chain: from the root on, each less those before it.
void ResponseSolver::accelerations(const mjModel& m, const mjData& d, int body,
                                   const double* wrench, std::span<double> out) {
  chain_.clear();
  for (int dof = last_dof(m, body); dof >= 0; dof = m.dof_parentid[dof]) chain_.push_back(dof);
  for (size_t n = chain_.size(); n-- > 0;) {
    const int dof = chain_[n], row = m.M_rowadr[dof];
    const double* column = columns_.data() + 6 * dof;
    double a = d.qLDiagInv[dof] * (dot3(column, wrench) + dot3(column + 3, wrench + 3));
    for (int k = 0; k + 1 < m.M_rownnz[dof]; ++k)
      a -= d.qLD[row + k] * by_dof_[static_cast<size_t>(m.M_colind[row + k])];
    by_dof_[static_cast<size_t>(dof)] = out[n] = a;
  }
}

int chain_length(const mjModel& m, int body) {
  int n = 0;
  for (int dof = last_dof(m, body); dof >= 0; dof = m.dof_parentid[dof]) ++n;
  return n;
}

}  // namespace gloam

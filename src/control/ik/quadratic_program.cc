#include "control/ik/quadratic_program.h"

#include <eiquadprog/eiquadprog-fast.hpp>

namespace gloam::ik {
namespace {

// The library accepts violations up to (rows) tr(H) tr(H^-1/2) 2e-14, which for a weakly damped H
// would be as large as a step. It therefore receives the problem in coordinates y = Lᵀ x, where
// H = L Lᵀ, times this factor: Hessian and tolerance are then 1e-6 and (rows) n² 2e-17.
constexpr double kScale = 1e-6;
// Largest violation of one inequality in a solution, relative to its bound.
constexpr double kLargestViolation = 1e-8;

bool satisfies(const Constraints& constraints, const VectorXd& x) {
  const auto keeps = [](double value, double bound) {
    return value - bound <= kLargestViolation * std::max(1.0, std::abs(bound));
  };
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (!keeps(x[i], constraints.upper[i]) || !keeps(-x[i], -constraints.lower[i])) return false;
  for (Eigen::Index i = 0; i < constraints.h.size(); ++i)
    if (!keeps(constraints.G.row(i).dot(x), constraints.h[i])) return false;
  return true;
}

}  // namespace

struct QuadraticProgram::Library {
  eiquadprog::solvers::EiquadprogFast solver;
  MatrixXd factor;            // H, then L below the diagonal
  MatrixXd hessian;           // of the scaled problem, (n x n)
  MatrixXd inverse;           // L⁻¹ᵀ
  MatrixXd C, no_equalities;  // C y + d >= 0: bounds below, bounds above, inequalities
  VectorXd c, d, no_values, y, x;
};

QuadraticProgram::QuadraticProgram(int n, int m)
    : n_(n), m_(m), library_(std::make_unique<Library>()) {
  Library& l = *library_;
  const int rows = 2 * n + m;
  l.solver.reset(static_cast<size_t>(n), 0, static_cast<size_t>(rows));
  l.factor.setZero(n, n);
  l.hessian = kScale * MatrixXd::Identity(n, n);
  l.inverse.setZero(n, n);
  l.C.setZero(rows, n);
  l.no_equalities.resize(0, n);
  l.c.setZero(n);
  l.d.setZero(rows);
  l.y.setZero(n);
  l.x.setZero(n);
}
QuadraticProgram::QuadraticProgram(QuadraticProgram&&) noexcept = default;
QuadraticProgram& QuadraticProgram::operator=(QuadraticProgram&&) noexcept = default;
QuadraticProgram::~QuadraticProgram() = default;

SolutionStatus QuadraticProgram::solve(const Objective& objective, const Constraints& constraints,
                                       VectorXd& x) {
  Library& l = *library_;
  if (n_ == 0) return SolutionStatus::kSolved;
  l.d << -constraints.lower, constraints.upper, constraints.h;
  l.factor = objective.H;
  const Eigen::LLT<Eigen::Ref<MatrixXd>> cholesky(l.factor);
  if (!objective.c.allFinite() || !constraints.G.allFinite() || l.d.array().isNaN().any() ||
      !l.factor.allFinite() || cholesky.info() != Eigen::Success) {
    return SolutionStatus::kSingular;
  }
  l.inverse.setIdentity(n_, n_);
  cholesky.matrixU().solveInPlace(l.inverse);
  l.c = kScale * l.inverse.transpose().lazyProduct(objective.c);
  l.C.topRows(n_) = l.inverse;
  l.C.middleRows(n_, n_) = -l.inverse;
  l.C.bottomRows(m_) = -constraints.G.lazyProduct(l.inverse);
  const auto status =
      l.solver.solve_quadprog(l.hessian, l.c, l.no_equalities, l.no_values, l.C, l.d, l.y);
  if (status == eiquadprog::solvers::EIQUADPROG_FAST_INFEASIBLE ||
      status == eiquadprog::solvers::EIQUADPROG_FAST_UNBOUNDED) {
    return SolutionStatus::kInfeasible;
  }
  l.x = l.inverse.lazyProduct(l.y);
  if (!l.x.allFinite()) return SolutionStatus::kSingular;
  if (!satisfies(constraints, l.x)) return SolutionStatus::kInfeasible;
  x = l.x;
  return SolutionStatus::kSolved;
}

}  // namespace gloam::ik

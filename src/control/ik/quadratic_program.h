#pragma once
// Strictly convex quadratic programs: min ½ xᵀ H x + cᵀ x with bounds and inequalities, by the dual
// active-set method of D. Goldfarb and A. Idnani, "A numerically stable dual method for solving
// strictly convex quadratic programs", 1983, in the library eiquadprog.

#include <memory>

#include "control/ik/constraints.h"
#include "control/ik/objective.h"

namespace gloam::ik {

class QuadraticProgram {
 public:
  /// Reserves memory for n variables and m inequalities beside the bounds.
  QuadraticProgram(int n, int m);
  QuadraticProgram(const QuadraticProgram& other) : QuadraticProgram(other.n_, other.m_) {}
  QuadraticProgram(QuadraticProgram&&) noexcept;
  QuadraticProgram& operator=(QuadraticProgram&&) noexcept;
  ~QuadraticProgram();

  /// The minimiser in `x` (n), untouched unless solved.
  SolutionStatus solve(const Objective& objective, const Constraints& constraints, VectorXd& x);

 private:
  struct Library;
  int n_, m_;
  std::unique_ptr<Library> library_;
};

}  // namespace gloam::ik

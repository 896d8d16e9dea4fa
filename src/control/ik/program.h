#pragma once
// A Problem on a model: tasks and limits, assembled and solved at one configuration after another.
// The core of gloam::ik::Solver and of the controller "ik".

#include "control/ik/collision_limit.h"
#include "control/ik/com_term.h"
#include "control/ik/frame_terms.h"
#include "control/ik/joint_limits.h"
#include "control/ik/joint_terms.h"
#include "control/ik/quadratic_program.h"

namespace gloam::ik {

/// A task is one line here and in gloam::ik::Task: term i implements task i.
using Term = std::variant<FrameTerm, RelativeFrameTerm, PostureTerm, ComTerm, DampingTerm>;
/// A limit is one line here and in gloam::ik::Limit.
using Rows = std::variant<ConfigurationRows, VelocityRows, CollisionRows>;

class Program {
 public:
  /// `dofs`: those that may move, ascending; all others keep their coordinates. Joints are in it
  /// with all of their degrees of freedom or with none. Errors: as for Solver::create.
  static Result<Program> create(const mjModel& model, std::vector<int> dofs,
                                const Problem& problem);
  Program(const Program&) = default;
  Program(Program&&) noexcept = default;

  /// Adds a limit of all velocities [rad/s, m/s].
  void limit_velocities(double limit);
  /// Adds a collision limit between given pairs, for at most `most` of them at a time.
  Status avoid(const CollisionLimit& options, GeomPairs pairs, int most);

  Status set_target(size_t task, const Pose& target);
  Status set_target(size_t task, std::span<const double> target);
  /// True once every task has a target.
  bool has_targets() const;
  /// Displacements for a step of dt [s] at qpos (nq), in x() (n). Does not allocate.
  SolutionStatus solve(const double* qpos, double dt);
  const VectorXd& x() const { return x_; }
  std::span<const double> error(size_t task) const;
  Kinematics& kinematics() { return at_; }
  const Kinematics& kinematics() const { return at_; }

 private:
  Program(Kinematics at, double damping);
  void reserve();

  Kinematics at_;
  double damping_;
  std::vector<Term> terms_;
  std::vector<Rows> rows_;
  Objective objective_;
  Constraints constraints_;
  QuadraticProgram solver_;
  VectorXd x_;
};

}  // namespace gloam::ik

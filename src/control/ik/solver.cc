// gloam::ik::Solver: a Program on the model of a World, for all of its degrees of freedom.

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "control/ik/program.h"
#include "control/ik/ranges.h"

namespace gloam::ik {

struct Solver::Impl {
  World world;  // keeps the model
  Program program;
  std::vector<double> velocity;
};

Solver::Solver(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;
Solver::~Solver() = default;

Result<Solver> Solver::create(const World& world, const Problem& problem) {
  const mjModel& model = *world.compiled()->model;
  std::vector<int> dofs(static_cast<size_t>(model.nv));
  std::iota(dofs.begin(), dofs.end(), 0);
  GLOAM_TRY(Program program, Program::create(model, std::move(dofs), problem));
  return Solver(std::make_unique<Impl>(
      Impl{world, std::move(program), std::vector<double>(static_cast<size_t>(model.nv))}));
}

Status Solver::set_target(size_t task, const Pose& target) {
  return impl_->program.set_target(task, target);
}
Status Solver::set_target(size_t task, std::span<const double> target) {
  return impl_->program.set_target(task, target);
}

Result<Solution> Solver::solve(std::span<const double> qpos, double dt) {
  Program& program = impl_->program;
  const auto nq = static_cast<size_t>(program.kinematics().model().nq);
  if (qpos.size() != nq) {
    return Error{ErrorKind::kInput, fmt::format("a configuration of this model has {} coordinates, "
                                                "not {}",
                                                nq, qpos.size())};
  }
  GLOAM_TRY_STATUS(check_finite(qpos, "the configuration"));
  if (!(dt > 0 && std::isfinite(dt))) return refuse_value("the time step must be positive");
  if (!program.has_targets()) return refuse_value("a task has no target yet");
  const SolutionStatus status = program.solve(qpos.data(), dt);
  std::vector<double>& velocity = impl_->velocity;
  for (size_t i = 0; i < velocity.size(); ++i)
    velocity[i] = status == SolutionStatus::kSolved ? program.x()[i] / dt : 0;
  return Solution{status, velocity};
}

std::span<const double> Solver::error(size_t task) const { return impl_->program.error(task); }

}  // namespace gloam::ik

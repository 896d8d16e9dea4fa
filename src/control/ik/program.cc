#include "control/ik/program.h"

#include <fmt/format.h>

#include "base/check.h"
#include "control/ik/ranges.h"

namespace gloam::ik {
namespace {

constexpr int kAllPairs = 4096;  // inequalities of one collision limit at most

template <class Variant, class Made>
Result<Variant> as(Result<Made> made) {
  if (!made.ok()) return std::move(made).error();
  return Variant(std::move(made).value());
}

Result<Term> make_term(const Kinematics& at, const Task& task) {
  struct Make {
    const Kinematics& at;
    Result<Term> operator()(const FrameTask& o) { return as<Term>(FrameTerm::create(at, o)); }
    Result<Term> operator()(const RelativeFrameTask& o) {
      return as<Term>(RelativeFrameTerm::create(at, o));
    }
    Result<Term> operator()(const PostureTask& o) { return as<Term>(PostureTerm::create(at, o)); }
    Result<Term> operator()(const ComTask& o) { return as<Term>(ComTerm::create(at, o)); }
    Result<Term> operator()(const DampingTask& o) { return as<Term>(DampingTerm::create(at, o)); }
  };
  return std::visit(Make{at}, task);
}

Result<Rows> make_rows(const Kinematics& at, const Limit& limit) {
  struct Make {
    const Kinematics& at;
    Result<Rows> operator()(const ConfigurationLimit& o) {
      return as<Rows>(ConfigurationRows::create(at, o));
    }
    Result<Rows> operator()(const VelocityLimit& o) {
      return as<Rows>(VelocityRows::create(at, o));
    }
    Result<Rows> operator()(const CollisionLimit& o) {
      GLOAM_TRY(GeomPairs pairs, collision_pairs(at.model(), o));
      return as<Rows>(CollisionRows::create(at, o, std::move(pairs), kAllPairs));
    }
  };
  return std::visit(Make{at}, limit);
}

Error other_target(size_t task) {
  return Error{ErrorKind::kInput,
               fmt::format("task {} takes another kind of target", task),
               {},
               "frames take a pose, postures and centres of mass take numbers"};
}

template <class Target>
Status set_target_of(std::vector<Term>& terms, size_t task, const Target& target) {
  if (task >= terms.size()) {
    return Error{ErrorKind::kInput,
                 fmt::format("there is no task {}; there are {}", task, terms.size())};
  }
  return std::visit(
      [&](auto& term) -> Status {
        if constexpr (requires { term.set_target(target); }) {
          return term.set_target(target);
        } else {
          return other_target(task);
        }
      },
      terms[task]);
}

}  // namespace

Program::Program(Kinematics at, double damping)
    : at_(std::move(at)), damping_(damping), solver_(0, 0) {}

Result<Program> Program::create(const mjModel& model, std::vector<int> dofs,
                                const Problem& problem) {
  if (!(problem.damping >= 0 && std::isfinite(problem.damping)))
    return refuse_value("'damping' must be finite and not negative");
  Program program(Kinematics(model, std::move(dofs)), problem.damping);
  for (const Task& task : problem.tasks) {
    GLOAM_TRY(Term term, make_term(program.at_, task));
    program.terms_.push_back(std::move(term));
  }
  for (const Limit& limit : problem.limits) {
    GLOAM_TRY(Rows rows, make_rows(program.at_, limit));
    program.rows_.push_back(std::move(rows));
  }
  program.reserve();
  return program;
}

void Program::limit_velocities(double limit) {
  rows_.push_back(VelocityRows::uniform(at_.size(), limit));
}

Status Program::avoid(const CollisionLimit& options, GeomPairs pairs, int most) {
  GLOAM_TRY(Rows rows, as<Rows>(CollisionRows::create(at_, options, std::move(pairs), most)));
  rows_.push_back(std::move(rows));
  reserve();
  return {};
}

void Program::reserve() {
  const int n = at_.size();
  int m = 0;
  for (const Rows& rows : rows_) m += std::visit([](const auto& r) { return r.count(); }, rows);
  constraints_.lower.resize(n);
  constraints_.upper.resize(n);
  constraints_.G.resize(m, n);
  constraints_.h.resize(m);
  objective_.reset(n, damping_);
  x_.setZero(n);
  solver_ = QuadraticProgram(n, m);
}

Status Program::set_target(size_t task, const Pose& target) {
  return set_target_of(terms_, task, target);
}
Status Program::set_target(size_t task, std::span<const double> target) {
  return set_target_of(terms_, task, target);
}

bool Program::has_targets() const {
  return std::ranges::all_of(terms_, [](const Term& term) {
    return std::visit([](const auto& t) { return t.has_target(); }, term);
  });
}

SolutionStatus Program::solve(const double* qpos, double dt) {
  at_.update(qpos);
  objective_.reset(at_.size(), damping_);
  for (Term& term : terms_) std::visit([&](auto& t) { t.add_to(objective_, at_); }, term);
  constraints_.reset();
  int first = 0;
  for (Rows& rows : rows_) {
    std::visit([&](auto& r) { r.add_to({&constraints_, first}, at_, dt); }, rows);
    first += std::visit([](const auto& r) { return r.count(); }, rows);
  }
  return solver_.solve(objective_, constraints_, x_);
}

std::span<const double> Program::error(size_t task) const {
  GLOAM_CHECK(task < terms_.size(), "there is no such task");
  return std::visit([](const auto& t) { return t.error(); }, terms_[task]);
}

}  // namespace gloam::ik

// Inverse kinematics: gloam.ik.

#include "gloam/joints/ik.h"

#include "core.h"

namespace gloam::python {
namespace {

ik::FrameName frame(const std::string& text) { return take(ik::parse_frame(text)); }

template <class Target>
void set_target(ik::Solver& solver, size_t task, const Target& target) {
  check(solver.set_target(task, target));
}

const char* name_of(ik::SolutionStatus status) {
  switch (status) {
    case ik::SolutionStatus::kInfeasible:
      return "infeasible";
    case ik::SolutionStatus::kSingular:
      return "singular";
    case ik::SolutionStatus::kSolved:
      break;
  }
  return "solved";
}

nb::tuple solve(ik::Solver& solver, nb::handle qpos, double dt) {
  const ik::Solution solution = take(solver.solve(doubles(qpos), dt));
  const auto size = solution.velocity.size();
  return nb::make_tuple(
      name_of(solution.status),
      new_array(std::vector<double>(solution.velocity.begin(), solution.velocity.end()), {size}));
}

nb::object error_of(const ik::Solver& solver, size_t task) {
  const std::span<const double> error = solver.error(task);
  return new_array(std::vector<double>(error.begin(), error.end()), {error.size()});
}

void bind_tasks(nb::class_<ik::Problem>& c) {
  c.def("add_frame", [](ik::Problem& p, const std::string& name, nb::handle position,
                        nb::handle orientation, double gain, double lm_damping) {
    p.tasks.push_back(ik::FrameTask{frame(name), vec3(position, "a position cost"),
                                    vec3(orientation, "an orientation cost"), gain, lm_damping});
  });
  c.def("add_relative_frame",
        [](ik::Problem& p, const std::string& name, const std::string& root, nb::handle position,
           nb::handle orientation, double gain, double lm_damping) {
          p.tasks.push_back(
              ik::RelativeFrameTask{frame(name), frame(root), vec3(position, "a position cost"),
                                    vec3(orientation, "an orientation cost"), gain, lm_damping});
        });
  c.def("add_posture", [](ik::Problem& p, nb::handle cost, double gain, double lm_damping) {
    p.tasks.push_back(ik::PostureTask{doubles(cost), gain, lm_damping});
  });
  c.def("add_com", [](ik::Problem& p, const std::string& body, nb::handle cost, double gain,
                      double lm_damping) {
    p.tasks.push_back(
        ik::ComTask{body, vec3(cost, "a cost of the centre of mass"), gain, lm_damping});
  });
  c.def("add_damping",
        [](ik::Problem& p, nb::handle cost) { p.tasks.push_back(ik::DampingTask{doubles(cost)}); });
}

void bind_limits(nb::class_<ik::Problem>& c) {
  c.def("add_configuration_limit", [](ik::Problem& p, double gain, double min_distance) {
    p.limits.push_back(ik::ConfigurationLimit{gain, min_distance});
  });
  c.def("add_velocity_limit",
        [](ik::Problem& p,
           const std::vector<std::pair<std::string, std::vector<double>>>& velocities) {
          p.limits.push_back(ik::VelocityLimit{velocities});
        });
  using Names = std::vector<std::string>;
  c.def("add_collision_limit",
        [](ik::Problem& p, const std::vector<std::pair<Names, Names>>& groups, double gain,
           double min_distance, double detection_distance, double bound_relaxation) {
          p.limits.push_back(
              ik::CollisionLimit{groups, gain, min_distance, detection_distance, bound_relaxation});
        });
}

}  // namespace

void bind_ik(nb::module_& m) {
  nb::class_<ik::Problem> problem(m, "IkProblem");
  problem.def(nb::init<>()).def_rw("damping", &ik::Problem::damping);
  bind_tasks(problem);
  bind_limits(problem);
  nb::class_<ik::Solver>(m, "IkSolver")
      .def_static("create", [](const World& world,
                               const ik::Problem& p) { return take(ik::Solver::create(world, p)); })
      .def("set_pose_target", [](ik::Solver& solver, size_t task,
                                 nb::handle target) { set_target(solver, task, pose(target)); })
      .def("set_target",
           [](ik::Solver& solver, size_t task, nb::handle target) {
             set_target(solver, task, std::span<const double>(doubles(target)));
           })
      .def("solve", &solve)
      .def("error", &error_of);
}

}  // namespace gloam::python

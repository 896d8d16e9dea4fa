// Time of one solution of gloam::ik on a robot.
//
//   ik_rate MODEL.xml SITE...
//
// A frame task for each site with a new target in each solution, a posture task, and limits of
// ranges and of velocities (3 rad/s), at random configurations within the ranges. Prints JSON:
// degrees of freedom and the median wall time of a solution [µs]. peers/mink_rate.py measures the
// same problem in Mink.

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "gloam/joints/ik.h"
#include "gloam/scene.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr int kSolutions = 2000;

class Benchmark {
 public:
  Benchmark(World world, std::vector<std::string> sites)
      : world_(std::move(world)), model_(*world_.compiled()->model), sites_(std::move(sites)) {}

  Status run() {
    GLOAM_TRY(ik::Solver solver, ik::Solver::create(world_, problem()));
    const std::vector<double> rest(model_.qpos0, model_.qpos0 + model_.nq);
    GLOAM_TRY_STATUS(solver.set_target(sites_.size(), rest));
    std::vector<double> times;
    for (int i = 0; i < kSolutions; ++i) {
      for (size_t task = 0; task < sites_.size(); ++task)
        GLOAM_TRY_STATUS(solver.set_target(
            task, Pose{{uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(0, 1)},
                       {uniform(0.1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}}));
      const std::vector<double> qpos = configuration();
      const auto begin = std::chrono::steady_clock::now();
      GLOAM_TRY(const ik::Solution solution, solver.solve(qpos, 0.01));
      const auto spent = std::chrono::steady_clock::now() - begin;
      if (solution.status != ik::SolutionStatus::kSolved)
        return Error{ErrorKind::kInput, "a problem has no solution"};
      times.push_back(std::chrono::duration<double, std::micro>(spent).count());
    }
    std::ranges::nth_element(times, times.begin() + kSolutions / 2);
    fmt::print("{{\"nv\": {}, \"solve_us\": {:.2f}}}\n", model_.nv, times[kSolutions / 2]);
    return {};
  }

 private:
  ik::Problem problem() const {
    ik::Problem problem;
    for (const std::string& site : sites_)
      problem.tasks.push_back(ik::FrameTask{{ik::FrameKind::kSite, site}});
    problem.tasks.push_back(ik::PostureTask{{0.1}});
    ik::VelocityLimit velocities;
    for (int joint = 0; joint < model_.njnt; ++joint)
      if (model_.jnt_type[joint] != mjJNT_FREE)
        velocities.velocities.push_back({mj_id2name(&model_, mjOBJ_JOINT, joint), {3}});
    problem.limits = {ik::ConfigurationLimit{}, velocities};
    problem.damping = 1e-6;
    return problem;
  }
  std::vector<double> configuration() {
    std::vector<double> qpos(model_.qpos0, model_.qpos0 + model_.nq);
    for (int joint = 0; joint < model_.njnt; ++joint)
      if (model_.jnt_limited[joint])
        qpos[static_cast<size_t>(model_.jnt_qposadr[joint])] =
            uniform(model_.jnt_range[2 * joint], model_.jnt_range[2 * joint + 1]);
    return qpos;
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }

  World world_;
  const mjModel& model_;
  std::vector<std::string> sites_;
  std::mt19937 random_{7};
};

Status run(int argc, char** argv) {
  GLOAM_TRY(const Scene scene, load_scene(argv[1]));
  GLOAM_TRY(World world, World::compile(scene));
  return Benchmark(std::move(world), {argv + 2, argv + argc}).run();
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: ik_rate MODEL.xml SITE...\n");
    return 2;
  }
  const gloam::Status status = gloam::run(argc, argv);
  if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
  return status.ok() ? 0 : status.error().exit_code();
}

#pragma once
// Model, controls, clock and statistics of the benchmarks of step rates.

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/rng.h"
#include "bench/command_line.h"
#include "scene/files/mujoco_guard.h"
#include "world/world.h"

namespace gloam {

/// CPU time of the thread that asks [s].
inline double thread_cpu_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Controls of one block, drawn before the clock starts, so that only the copy is timed.
class ControlTable {
 public:
  ControlTable(const mjModel& model, int block)
      : nu_(static_cast<int>(model.nu)), values_(static_cast<size_t>(nu_ * block)) {
    for (int i = 0; i < nu_; ++i) {
      const bool limited = model.actuator_ctrllimited[i];
      low_.push_back(limited ? model.actuator_ctrlrange[2 * i] : -1);
      high_.push_back(limited ? model.actuator_ctrlrange[2 * i + 1] : 1);
    }
  }
  void draw(int64_t first_step) {
    constexpr RandomStream stream{1, stream_id("bench.control")};
    for (size_t k = 0; k < values_.size(); ++k) {
      const auto i = k % static_cast<size_t>(nu_);
      const double u = stream.uniform(static_cast<uint64_t>(first_step), static_cast<uint32_t>(k));
      values_[k] = low_[i] + u * (high_[i] - low_[i]);
    }
    first_step_ = first_step;
  }
  void apply(int64_t step, mjData* data) const {
    if (nu_ > 0) mju_copy(data->ctrl, values_.data() + (step - first_step_) * nu_, nu_);
  }

 private:
  int nu_;
  std::vector<double> low_, high_, values_;
  int64_t first_step_ = 0;
};

inline void add_floor_and_motors(mjSpec* spec) {
  mjsGeom* floor = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
  floor->type = mjGEOM_PLANE;
  floor->size[0] = floor->size[1] = floor->size[2] = 1;
  for (mjsElement* e = mjs_firstElement(spec, mjOBJ_JOINT); e != nullptr;
       e = mjs_nextElement(spec, e)) {
    const mjsJoint* joint = mjs_asJoint(e);
    const std::string name = mjs_getString(mjs_getName(e));
    if (joint->type == mjJNT_FREE || joint->type == mjJNT_BALL || name.empty()) continue;
    mjsActuator* motor = mjs_addActuator(spec, nullptr);
    mjs_setToMotor(motor);
    motor->trntype = mjTRN_JOINT;
    mjs_setString(motor->target, name.c_str());
    motor->ctrllimited = mjLIMITED_TRUE;
    motor->ctrlrange[0] = -10, motor->ctrlrange[1] = 10;
  }
}

/// The model of a file. One without actuators gets a floor and a motor on every joint, so that the
/// robot lies on the ground and moves; `bare` leaves it as it is.
inline Result<std::shared_ptr<const CompiledWorld>> load_step_model(const std::string& file,
                                                                    bool bare) {
  install_mujoco_handler();
  char error[1000] = "";
  auto world = std::make_shared<CompiledWorld>();
  const SpecPtr spec(mj_parseXML(file.c_str(), nullptr, error, sizeof(error)));
  if (!spec) return Error{ErrorKind::kInput, error};
  const bool has_actuators = mjs_firstElement(spec.get(), mjOBJ_ACTUATOR) != nullptr;
  if (!has_actuators && !bare) add_floor_and_motors(spec.get());
  world->model.reset(mj_compile(spec.get(), nullptr));
  if (!world->model) return Error{ErrorKind::kInput, mjs_getError(spec.get())};
  RobotInstance robot;
  robot.root_body = 1;
  world->robots.push_back(robot);
  return std::shared_ptr<const CompiledWorld>(world);
}

struct StepOptions {
  std::string model;
  int pairs = 60;
  int block = 2000;  ///< steps
  bool bare = false, json = false;
};

/// `main` of a bench: its options from the command line, then `run`.
inline int run_step_bench(int argc, char** argv, const char* name, int least_pairs,
                          Status (*run)(const StepOptions&)) {
  StepOptions options;
  CommandLine line(argc, argv);
  options.bare = line.flag("--bare");
  options.json = line.flag("--json");
  line.value("--pairs", &options.pairs, least_pairs);
  line.value("--block", &options.block);
  if (line.words().size() != 1) {
    fmt::print(stderr, "usage: {} MODEL.xml [--pairs N] [--block STEPS] [--bare] [--json]\n", name);
    return 2;
  }
  options.model = line.words()[0];
  return exit_code(run(options));
}

/// Median of ratios and the lower end of its one-sided 95 % confidence interval from order
/// statistics.
struct RatioSummary {
  double median = 0, lower_95 = 0;
};
inline RatioSummary summarise(std::vector<double> ratios) {
  std::sort(ratios.begin(), ratios.end());
  const auto n = static_cast<double>(ratios.size());
  // Binomial(n, 1/2): the rank below the median that it exceeds with 95 % probability.
  const auto rank =
      static_cast<size_t>(std::max(0.0, std::floor(0.5 * (n - 1.645 * std::sqrt(n)))));
  return {0.5 * (ratios[ratios.size() / 2] + ratios[(ratios.size() - 1) / 2]), ratios[rank]};
}

}  // namespace gloam

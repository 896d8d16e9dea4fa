// Cost of a step through the Simulator against a bare mj_step loop: the same model, the same
// controls, alternating blocks in one process, CPU time of the thread that steps.
//
//   sim_step_rate MODEL.xml [--pairs N] [--block STEPS] [--bare] [--json]
//
// A model without actuators gets a floor and a motor on every joint, so that the robot lies on the
// ground and moves; --bare leaves it as it is. Prints the median of bare time / Simulator time per
// pair (1 = no overhead) and the lower end of its 95 % confidence interval from order statistics.

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/hash.h"
#include "base/rng.h"
#include "scene/mujoco_guard.h"
#include "sim/simulator.h"
#include "sim/state_layout.h"

namespace gloam {
namespace {

struct Options {
  const char* model = nullptr;
  int pairs = 60;
  int block = 2000;
  bool bare = false, json = false;
};

double thread_cpu_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Controls of one block, drawn before the clock starts, so that only the copy is timed.
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

class TableController final : public Controller {
 public:
  explicit TableController(const ControlTable& table) : table_(table) {}
  void reset(const mjModel*, const mjData*) override {}
  void control(const mjModel*, mjData* data, int64_t step, double, const VelocityTarget&) override {
    table_.apply(step, data);
  }

 private:
  const ControlTable& table_;
};

void add_floor_and_motors(mjSpec* spec) {
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

Result<std::shared_ptr<const CompiledWorld>> load(const Options& options) {
  install_mujoco_handler();
  char error[1000] = "";
  auto world = std::make_shared<CompiledWorld>();
  const SpecPtr spec(mj_parseXML(options.model, nullptr, error, sizeof(error)));
  if (!spec) return Error{ErrorKind::kInput, error};
  const bool has_actuators = mjs_firstElement(spec.get(), mjOBJ_ACTUATOR) != nullptr;
  if (!has_actuators && !options.bare) add_floor_and_motors(spec.get());
  world->model.reset(mj_compile(spec.get(), nullptr));
  if (!world->model) return Error{ErrorKind::kInput, mjs_getError(spec.get())};
  RobotInstance robot;
  robot.root_body = 1;
  world->robots.push_back(robot);
  return std::shared_ptr<const CompiledWorld>(world);
}

// Nanoseconds of the state copy and the hash of one step, measured alone.
double hash_cost(const mjModel& model, const mjData& data) {
  std::vector<double> state(static_cast<size_t>(state_size(model)));
  constexpr int kRepeats = 100000;
  uint64_t hash = 0;
  const double begin = thread_cpu_time();
  for (int i = 0; i < kRepeats; ++i) {
    mj_getState(&model, &data, state.data(), mjSTATE_INTEGRATION);
    hash = hash_span<double>(state, hash);
  }
  const double ns = 1e9 * (thread_cpu_time() - begin) / kRepeats;
  return hash == 0 ? 0 : ns;  // the hash is used, so the loop is not optimised away
}

Status run(const Options& options) {
  GLOAM_TRY(const std::shared_ptr<const CompiledWorld> world, load(options));
  const mjModel* model = world->model.get();
  DataPtr data(mj_makeData(model));
  ControlTable table(*model, options.block);
  GLOAM_TRY(const std::unique_ptr<Simulator> simulator,
            Simulator::create(world, {.pace = Pace::kLockstep}));
  const Rational dt = simulator->timestep();
  GLOAM_TRY_STATUS(
      simulator->add_controller(0, std::make_unique<TableController>(table), {dt.den, dt.num}));
  simulator->start();

  std::vector<double> ratios;
  double bare_total = 0, simulator_total = 0;
  int64_t step = 0;
  for (int pair = -2; pair < options.pairs; ++pair) {  // the first two warm up
    table.draw(step);
    auto bare_block = [&] {
      const double begin = thread_cpu_time();
      for (int64_t n = step; n < step + options.block; ++n) {
        table.apply(n, data.get());
        mj_step(model, data.get());
      }
      return thread_cpu_time() - begin;
    };
    Status status;
    auto simulator_block = [&] {
      const double begin = simulator->cpu_time();
      status = simulator->step(options.block);
      return simulator->cpu_time() - begin;
    };
    double bare = 0, through = 0;
    if (pair % 2 == 0) {  // neither is always first
      bare = bare_block();
      through = simulator_block();
    } else {
      through = simulator_block();
      bare = bare_block();
    }
    GLOAM_TRY_STATUS(status);
    step += options.block;
    if (pair < 0) continue;
    ratios.push_back(bare / through);
    bare_total += bare;
    simulator_total += through;
  }
  const Snapshot last = simulator->latest();
  std::vector<double> state(last.state().size());
  mj_getState(model, data.get(), state.data(), mjSTATE_INTEGRATION);
  if (std::memcmp(state.data(), last.state().data(), state.size() * sizeof(double)) != 0) {
    return Error{ErrorKind::kInput, "the two loops ended in different states"};
  }

  std::sort(ratios.begin(), ratios.end());
  const auto n = static_cast<double>(ratios.size());
  const double median = 0.5 * (ratios[ratios.size() / 2] + ratios[(ratios.size() - 1) / 2]);
  // Binomial(n, 1/2): the rank below the median that it exceeds with 95 % probability.
  const auto rank =
      static_cast<size_t>(std::max(0.0, std::floor(0.5 * (n - 1.645 * std::sqrt(n)))));
  const double per_step = 1e6 / (n * options.block);
  const double bare_us = bare_total * per_step, simulator_us = simulator_total * per_step;
  const double hash_ns = hash_cost(*model, *data);
  if (options.json) {
    fmt::print(
        "{{\"name\": \"sim_step_rate\", \"pairs\": {}, \"block\": {}, \"median_ratio\": {:.5f}, "
        "\"lower_95\": {:.5f}, \"bare_us\": {:.3f}, \"simulator_us\": {:.3f}, \"hash_ns\": "
        "{:.1f}, \"state_size\": {}}}\n",
        ratios.size(), options.block, median, ratios[rank], bare_us, simulator_us, hash_ns,
        state.size());
  } else {
    fmt::print(
        "step rate through the Simulator / bare mj_step: {:.4f} (lower 95 % bound {:.4f}, "
        "{} pairs of {} steps)\n",
        median, ratios[rank], ratios.size(), options.block);
    fmt::print(
        "per step: bare {:.3f} µs, Simulator {:.3f} µs; state copy and hash {:.0f} ns of {} "
        "numbers\n",
        bare_us, simulator_us, hash_ns, state.size());
  }
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--bare") {
      options.bare = true;
    } else if (word == "--json") {
      options.json = true;
    } else if (word == "--pairs" && i + 1 < argc) {
      options.pairs = std::max(10, std::atoi(argv[++i]));
    } else if (word == "--block" && i + 1 < argc) {
      options.block = std::max(1, std::atoi(argv[++i]));
    } else {
      options.model = argv[i];
    }
  }
  if (options.model == nullptr) {
    fmt::print(stderr,
               "usage: sim_step_rate MODEL.xml [--pairs N] [--block STEPS] [--bare] [--json]\n");
    return 2;
  }
  const gloam::Status status = gloam::run(options);
  if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
  return status.ok() ? 0 : status.error().exit_code();
}

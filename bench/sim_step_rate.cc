// Cost of a step through the Simulator against a bare mj_step loop: the same model, the same
// controls, alternating blocks in one process, CPU time of the thread that steps.
//
//   sim_step_rate MODEL.xml [--pairs N] [--block STEPS] [--bare] [--json]
//
// A model without actuators gets a floor and a motor on every joint, so that the robot lies on the
// ground and moves; --bare leaves it as it is. Prints the median of bare time / Simulator time per
// pair (1 = no overhead) and the lower end of its 95 % confidence interval from order statistics.

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "base/hash.h"
#include "bench/step_model.h"
#include "sim/loop/simulator.h"
#include "sim/state/state_layout.h"

namespace gloam {
namespace {

class TableController final : public Controller {
 public:
  explicit TableController(const ControlTable& table) : table_(table) {}
  void reset(const mjModel*, const mjData*) override {}
  void control(const ControlInputs& in) override { table_.apply(in.step, in.data); }

 private:
  const ControlTable& table_;
};

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

Status run(const StepOptions& options) {
  GLOAM_TRY(const std::shared_ptr<const CompiledWorld> world,
            load_step_model(options.model, options.bare));
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

  const RatioSummary summary = summarise(ratios);
  const double per_step = 1e6 / (static_cast<double>(options.pairs) * options.block);
  const double bare_us = bare_total * per_step, simulator_us = simulator_total * per_step;
  const double hash_ns = hash_cost(*model, *data);
  if (options.json) {
    fmt::print(
        "{{\"name\": \"sim_step_rate\", \"pairs\": {}, \"block\": {}, \"median_ratio\": {:.5f}, "
        "\"lower_95\": {:.5f}, \"bare_us\": {:.3f}, \"simulator_us\": {:.3f}, \"hash_ns\": "
        "{:.1f}, \"state_size\": {}}}\n",
        ratios.size(), options.block, summary.median, summary.lower_95, bare_us, simulator_us,
        hash_ns, state.size());
  } else {
    fmt::print(
        "step rate through the Simulator / bare mj_step: {:.4f} (lower 95 % bound {:.4f}, "
        "{} pairs of {} steps)\n",
        summary.median, summary.lower_95, ratios.size(), options.block);
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
  return gloam::run_step_bench(argc, argv, "sim_step_rate", 10, gloam::run);
}

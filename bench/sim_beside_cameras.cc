// Cost of a step while two cameras render: through the Simulation that the cameras belong to,
// against a bare mj_step loop while the same two cameras render in another process.
//
//   sim_beside_cameras MODEL.xml [--pairs N] [--block STEPS] [--json]
//
// Three processes, of which two run at a time: "ours" steps and renders; "renderer" renders, its
// own physics at real time; the first one steps bare. Those whose turn it is not are stopped by
// signal, in the middle of their frames, so that every block finds both cameras at work. Only the
// CPU time of the thread that steps counts. Prints the median of bare time / ours per pair (1 = the
// cameras cost the physics nothing beyond what any load on the machine does), the lower end of its
// 95 % confidence interval, and how much CPU time rendering took beside each loop.

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string_view>
#include <utility>

#include "base/hash.h"
#include "bench/step_model.h"
#include "runtime/live/live_simulation.h"
#include "sim/state/state_layout.h"

namespace gloam {
namespace {

/// Two views of the model in 640 x 480, path traced and denoised: what a recorded run does.
struct TwoCameras {
  std::unique_ptr<CameraStream> streams[2];

  Status open(Simulation& simulation, Rational rate) {
    for (int i = 0; i < 2; ++i) {
      CameraRequest request;
      request.rate = rate;
      request.width = 640, request.height = 480;
      GLOAM_TRY(streams[i],
                simulation.open_camera(request, [](std::shared_ptr<const CameraFrame>) {}));
    }
    Pose X_WC = streams[1]->pose();
    X_WC.p.z += 0.1;
    streams[1]->set_pose(X_WC);
    return {};
  }
};

/// Message from one process to the other after a turn.
struct Report {
  double step_seconds = 0;  // CPU time of the thread that steps
  double all_seconds = 0;   // of the whole process
  uint64_t state = 0;       // hash of where the simulation stands
};

double process_cpu_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A process that waits for its turns at the end of a pipe. It dies with its parent.
class Helper {
 public:
  /// `serve(in, out)` reads a byte per turn and writes a Report.
  template <class F>
  explicit Helper(F&& serve) {
    int ask[2], answer[2];
    if (::pipe(ask) != 0 || ::pipe(answer) != 0) std::exit(3);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      ::close(ask[1]), ::close(answer[0]);
      const Status status = serve(ask[0], answer[1]);
      if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
      std::_Exit(status.ok() ? 0 : 1);
    }
    ::close(ask[0]), ::close(answer[1]);
    in_ = answer[0], out_ = ask[1];
  }
  ~Helper() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(in_), ::close(out_);
  }
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  void go_on() const { ::kill(pid_, SIGCONT); }
  void hold() const {
    ::kill(pid_, SIGSTOP);
    ::waitpid(pid_, nullptr, WUNTRACED);  // until it stands still
  }
  Result<Report> turn() const {
    Report report;
    if (::write(out_, "t", 1) != 1 || ::read(in_, &report, sizeof(report)) != sizeof(report)) {
      return Error{ErrorKind::kInput, "a process that the bench needs has ended"};
    }
    return report;
  }

 private:
  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;
};

bool wait_for_turn(int in) {
  char byte = 0;
  return ::read(in, &byte, 1) == 1;
}
void answer(int out, const Report& report) {
  if (::write(out, &report, sizeof(report)) != sizeof(report)) std::_Exit(1);
}

uint64_t hash_state(std::span<const double> state) { return hash_span<double>(state, 0); }

/// Steps through the Simulation that two cameras look at.
Status serve_ours(const std::shared_ptr<const CompiledWorld>& compiled, int block, int in,
                  int out) {
  GLOAM_TRY(const auto simulation,
            LiveSimulation::create(World(compiled), {.pace = Pace::kLockstep}));
  ControlTable table(*compiled->model, block);
  int64_t step = 0;
  static_cast<void>(
      simulation->set_step_hook([&](const mjModel*, mjData* data) { table.apply(step++, data); }));
  TwoCameras cameras;
  GLOAM_TRY_STATUS(cameras.open(*simulation, {20, 1}));
  while (wait_for_turn(in)) {
    table.draw(step);
    const double all = process_cpu_time(), begin = simulation->simulator().cpu_time();
    GLOAM_TRY_STATUS(simulation->step(block));
    answer(out, {simulation->simulator().cpu_time() - begin, process_cpu_time() - all,
                 hash_state(simulation->latest().state())});
  }
  return {};
}

/// Renders without end. Physics runs at real time, the cameras want a frame of every step.
Status serve_renderer(const std::shared_ptr<const CompiledWorld>& compiled, int in, int out) {
  GLOAM_TRY(const auto simulation,
            LiveSimulation::create(World(compiled), {.pace = Pace::kRealTime}));
  TwoCameras cameras;
  GLOAM_TRY_STATUS(cameras.open(*simulation, simulation->step_rate()));
  simulation->resume();
  while (wait_for_turn(in)) answer(out, {0, process_cpu_time(), 0});
  return {};
}

Status run(const StepOptions& options) {
  GLOAM_TRY(const auto compiled, load_step_model(options.model, options.bare));
  ::signal(SIGPIPE, SIG_IGN);  // a helper that ends is told as an error
  const Helper ours([&](int in, int out) { return serve_ours(compiled, options.block, in, out); });
  const Helper renderer([&](int in, int out) { return serve_renderer(compiled, in, out); });
  const mjModel* model = compiled->model.get();
  const DataPtr data(mj_makeData(model));
  ControlTable table(*model, options.block);
  GLOAM_TRY(Report before, renderer.turn());  // it is up
  renderer.hold();
  GLOAM_TRY(Report through, ours.turn());  // the block that both begin with
  ours.hold();

  std::vector<double> ratios;
  double bare_total = 0, ours_total = 0, beside_bare = 0, beside_ours = 0;
  int64_t step = 0;
  const auto bare_block = [&]() -> Result<double> {
    table.draw(step);
    renderer.go_on();
    GLOAM_TRY(before, renderer.turn());
    const double begin = thread_cpu_time();
    for (const int64_t end = step + options.block; step < end; ++step) {
      table.apply(step, data.get());
      mj_step(model, data.get());
    }
    const double seconds = thread_cpu_time() - begin;
    GLOAM_TRY(const Report after, renderer.turn());
    renderer.hold();
    beside_bare += after.all_seconds - before.all_seconds;
    return seconds;
  };
  const auto our_block = [&]() -> Status {
    ours.go_on();
    GLOAM_TRY(through, ours.turn());
    ours.hold();
    beside_ours += through.all_seconds - through.step_seconds;
    return {};
  };
  GLOAM_TRY_STATUS(bare_block());
  for (int pair = -2; pair < options.pairs; ++pair) {  // the first two warm up
    if (pair == 0) beside_bare = beside_ours = 0;
    double bare = 0;
    if (pair % 2 == 0) {  // neither is always first
      GLOAM_TRY(bare, bare_block());
      GLOAM_TRY_STATUS(our_block());
    } else {
      GLOAM_TRY_STATUS(our_block());
      GLOAM_TRY(bare, bare_block());
    }
    if (pair < 0) continue;
    ratios.push_back(bare / through.step_seconds);
    bare_total += bare;
    ours_total += through.step_seconds;
  }
  std::vector<double> state(static_cast<size_t>(state_size(*model)));
  mj_getState(model, data.get(), state.data(), mjSTATE_INTEGRATION);
  if (hash_state(state) != through.state) {
    return Error{ErrorKind::kInput, "the two loops ended in different states"};
  }

  const RatioSummary summary = summarise(ratios);
  const double per_step = 1e6 / (static_cast<double>(options.pairs) * options.block);
  const double load_bare = beside_bare / bare_total, load_ours = beside_ours / ours_total;
  if (options.json) {
    fmt::print(
        "{{\"name\": \"sim_beside_cameras\", \"pairs\": {}, \"block\": {}, \"median_ratio\": "
        "{:.5f}, \"lower_95\": {:.5f}, \"bare_us\": {:.3f}, \"simulator_us\": {:.3f}, "
        "\"rendering_beside_bare\": {:.3f}, \"rendering_beside_simulator\": {:.3f}}}\n",
        ratios.size(), options.block, summary.median, summary.lower_95, bare_total * per_step,
        ours_total * per_step, load_bare, load_ours);
  } else {
    fmt::print(
        "step rate beside two cameras / bare beside the same: {:.4f} (lower 95 % bound {:.4f}, {} "
        "pairs of {} steps)\n",
        summary.median, summary.lower_95, ratios.size(), options.block);
    fmt::print(
        "per step: bare {:.3f} µs, ours {:.3f} µs; CPU time of rendering per CPU time of stepping: "
        "beside bare {:.2f}, beside ours {:.2f}\n",
        bare_total * per_step, ours_total * per_step, load_bare, load_ours);
  }
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  return gloam::run_step_bench(argc, argv, "sim_beside_cameras", 2, gloam::run);
}

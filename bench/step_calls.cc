// Time of a call of Simulation::step(1), for comparison with the same call from Python:
// bench_step_calls SCENE STEPS -> {"wall_us": …, "caller_us": …}, the latter of the CPU and of the
// calling thread alone.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "gloam/simulation.h"

namespace {
double thread_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: bench_step_calls SCENE STEPS\n");
    return 2;
  }
  const auto fail = [](const gloam::Error& error) {
    std::fprintf(stderr, "bench_step_calls: %s\n", error.to_string().c_str());
    return error.exit_code();
  };
  const int steps = std::atoi(argv[2]);
  const auto scene = gloam::load_scene(argv[1]);
  if (!scene.ok()) return fail(scene.error());
  const auto world = gloam::World::compile(*scene);
  if (!world.ok()) return fail(world.error());
  const auto simulation = gloam::Simulation::create(*world, {.pace = gloam::Pace::kLockstep});
  if (!simulation.ok()) return fail(simulation.error());
  if (const auto status = (*simulation)->step(200); !status.ok()) return fail(status.error());
  const double thread_start = thread_seconds();
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < steps; ++i)
    if (const auto status = (*simulation)->step(1); !status.ok()) return fail(status.error());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const double caller = thread_seconds() - thread_start;
  std::printf("{\"wall_us\": %.3f, \"caller_us\": %.3f}\n", taken.count() / steps * 1e6,
              caller / steps * 1e6);
  return 0;
}

// Time of a call of Simulation::step(1), for comparison with the same call from Python:
// bench_step_calls SCENE STEPS -> {"microseconds": …}.

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "gloam/simulation.h"

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
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < steps; ++i)
    if (const auto status = (*simulation)->step(1); !status.ok()) return fail(status.error());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("{\"microseconds\": %.3f}\n", taken.count() / steps * 1e6);
  return 0;
}

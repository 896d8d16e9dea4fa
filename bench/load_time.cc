// Time from the start of a fresh process to a model that can be stepped or seen.
//
//   load_time MODEL.xml physics   until the first step can be taken
//   load_time MODEL.xml render    until the first ray can be traced as well
//
// Prints the process's CPU time since its start, all threads, and the wall clock at that moment,
// both in seconds: whoever starts the process subtracts the clock of the start. The baseline is
// bare/load.cc, a program that links MuJoCo alone.

#include <fmt/format.h>
#include <time.h>

#include <string_view>

#include "gloam/scene.h"
#include "gloam/simulation.h"
#include "runtime/live/live_simulation.h"

namespace gloam {
namespace {

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void print_ready() {
  fmt::print("{:.6f} {:.6f}\n", seconds(CLOCK_PROCESS_CPUTIME_ID), seconds(CLOCK_MONOTONIC));
  std::fflush(stdout);
}

// Builds all that the first ray needs: description, buffers, the trees over triangles.
Status make_renderer(LiveSimulation& simulation) {
  GLOAM_TRY(const auto shared, simulation.renderer());
  GLOAM_TRY(const auto solver, PoseSolver::create(simulation.world().compiled()));
  PoseFrame poses;
  GLOAM_TRY_STATUS(solver->solve(simulation.latest(), poses));
  shared->renderer->update(poses, poses, poses);
  return {};
}

Status run(const char* model, bool renders) {
  GLOAM_TRY(const Scene scene, load_scene(model));
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(const auto simulation, LiveSimulation::create(world, {}));
  if (renders) GLOAM_TRY_STATUS(make_renderer(*simulation));
  print_ready();
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  const std::string_view what = argc == 3 ? argv[2] : "";
  if (what != "physics" && what != "render") {
    fmt::print(stderr, "usage: load_time MODEL.xml physics|render\n");
    return 2;
  }
  const gloam::Status status = gloam::run(argv[1], what == "render");
  if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
  return status.ok() ? 0 : status.error().exit_code();
}

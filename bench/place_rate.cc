// How fast stock MuJoCo steps a scene's model, on one core: what a generated place costs.
//
//   place_rate SCENE.toml [SECONDS]
//
// Steps SECONDS of simulation time (5) after one second to settle, controls at zero. Prints JSON:
// bodies, things (bodies directly under the world), dofs, contacts at the end, CPU time of a step
// [µs] and simulation time / CPU time.

#include <fmt/format.h>
#include <mujoco/mujoco.h>
#include <time.h>

#include <cstdlib>
#include <memory>

#include "gloam/scene.h"
#include "world/world.h"

namespace gloam {
namespace {

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Status run(const char* file, double seconds) {
  GLOAM_TRY(const Scene scene, load_scene(file));
  GLOAM_TRY(const World world, World::compile(scene));
  const mjModel& m = *world.compiled()->model;
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&m), mj_deleteData);
  mjData* d = data.get();
  if (world.compiled()->initial_key >= 0)
    mj_resetDataKeyframe(&m, d, world.compiled()->initial_key);
  const auto steps = static_cast<int>(seconds / m.opt.timestep);
  for (int i = 0; i < static_cast<int>(1 / m.opt.timestep); ++i) mj_step(&m, d);
  const double begin = cpu_seconds();
  for (int i = 0; i < steps; ++i) mj_step(&m, d);
  const double spent = cpu_seconds() - begin;
  int things = 0;
  for (int b = 1; b < static_cast<int>(m.nbody); ++b) things += m.body_parentid[b] == 0;
  fmt::print(
      "{{\"bodies\": {}, \"things\": {}, \"dofs\": {}, \"contacts\": {}, \"step_us\": {:.1f}, "
      "\"real_time\": {:.3f}}}\n",
      m.nbody, things, m.nv, d->ncon, 1e6 * spent / steps, steps * m.opt.timestep / spent);
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: place_rate SCENE.toml [SECONDS]\n");
    return 2;
  }
  const gloam::Status status = gloam::run(argv[1], argc == 3 ? std::atof(argv[2]) : 5);
  if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
  return status.ok() ? 0 : status.error().exit_code();
}

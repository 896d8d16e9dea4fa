// Time of one RGB picture of the direct tier (primary hit, direct light, shadows), as a live camera
// takes it: physics has moved, so every frame solves poses, moves the scene, renders, tone-maps.
//
//   direct_rate MODEL CAMERA [--size WxH] [--spp N] [--frames N] [--tier T] [--picture FILE.png]
//   direct_rate MODEL CAMERA --truth [--size WxH] [--frames N]: depth and segmentation instead
//
// No denoising. Prints the medians over the frames, without the two that warm up, as
// "WALL ms CPU ms"; physics itself is not timed.

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "base/files.h"
#include "bench/command_line.h"
#include "bench/median.h"
#include "gloam/scene.h"
#include "render/film/png.h"
#include "runtime/live/live_simulation.h"

namespace gloam {
namespace {

struct Options {
  std::string model, camera, picture, tier = "direct";
  int width = 640, height = 480, spp = 1, frames = 20;
  bool truth = false;
};

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Status run(const Options& options) {
  GLOAM_TRY(const Scene scene, load_scene(options.model));
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(const auto simulation, LiveSimulation::create(world, {.pace = Pace::kLockstep}));
  GLOAM_TRY(const auto shared, simulation->renderer());
  GLOAM_TRY(const auto solver, PoseSolver::create(world.compiled()));
  CameraRequest request;
  request.camera = options.camera;
  request.width = options.width, request.height = options.height;
  GLOAM_TRY(request.render.tier, enum_named<RenderTier>(options.tier));
  request.render.spp = options.spp;
  request.render.denoise = false;
  if (options.truth) request.outputs = {"depth", "segmentation"};
  GLOAM_TRY(const auto sensor, CameraSensor::create(shared->description, request, 1));

  constexpr int kWarmUp = 2;
  std::vector<double> wall, cpu;
  std::shared_ptr<const CameraFrame> frame;
  PoseFrame now, previous;
  for (int i = -kWarmUp; i < options.frames; ++i) {
    GLOAM_TRY_STATUS(simulation->step(1));
    const Snapshot snapshot = simulation->latest();
    const double wall_begin = seconds(CLOCK_MONOTONIC);
    const double cpu_begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
    GLOAM_TRY_STATUS(solver->solve(snapshot, now));
    frame = sensor->capture(*shared->renderer, shared->turns, now, i > -kWarmUp ? previous : now,
                            i + kWarmUp);
    const double wall_end = seconds(CLOCK_MONOTONIC);
    const double cpu_end = seconds(CLOCK_PROCESS_CPUTIME_ID);
    std::swap(now, previous);
    if (i < 0) continue;
    wall.push_back(wall_end - wall_begin);
    cpu.push_back(cpu_end - cpu_begin);
  }
  if (!options.picture.empty()) {
    GLOAM_TRY_STATUS(write_file_atomic(options.picture,
                                       encode_png8(options.width, options.height, 3, frame->rgb)));
  }
  fmt::print("{:.3f} ms {:.3f} ms\n", 1e3 * median(wall), 1e3 * median(cpu));
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  gloam::CommandLine line(argc, argv);
  line.size(&options.width, &options.height);
  line.value("--spp", &options.spp);
  line.value("--frames", &options.frames);
  line.value("--tier", &options.tier);
  options.truth = line.flag("--truth");
  line.value("--picture", &options.picture);
  if (line.words().size() != 2) {
    fmt::print(stderr,
               "usage: direct_rate MODEL CAMERA [--size WxH] [--spp N] [--frames N] [--tier T] "
               "[--picture FILE.png] [--truth]\n");
    return 2;
  }
  options.model = line.words()[0], options.camera = line.words()[1];
  return gloam::exit_code(gloam::run(options));
}

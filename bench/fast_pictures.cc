// Pictures of the fast tier, taken one after the other as a live camera does, and of the path tier
// at the same instants, for bench/fast_error.py to compare.
//
//   fast_pictures SCENE CAMERA OUT [--size WxH] [--rate HZ] [--frames N] [--at I,J …] [--spp N]
//
// Writes OUT/fast_I.png and OUT/path_I.png for the frames I, J … (default: the last), and prints
// "frame I mean FAST PATH" with the mean luminance of both [cd/m²].

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string_view>

#include "base/files.h"
#include "gloam/scene.h"
#include "render/film/png.h"
#include "runtime/live_simulation.h"

namespace gloam {
namespace {

struct Options {
  std::string model, camera, out;
  int width = 320, height = 240, rate = 20, frames = 20, spp = 512;
  std::set<int> at;
};

double mean_luminance(const CameraFrame& frame) {
  double sum = 0;
  const size_t n = frame.radiance.size() / 3;
  for (size_t i = 0; i < n; ++i) {
    sum += 0.2126 * frame.radiance[3 * i] + 0.7152 * frame.radiance[3 * i + 1] +
           0.0722 * frame.radiance[3 * i + 2];
  }
  return sum / static_cast<double>(n);
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
  request.outputs = {"rgb", "radiance"};
  request.render = scene.render;
  request.render.tier = "fast";
  GLOAM_TRY(const auto fast, CameraSensor::create(shared->description, request, 1));
  request.render.tier = "path";
  request.render.spp = options.spp;
  request.render.denoise = true;  // what is left of the noise of so many samples
  GLOAM_TRY(const auto path, CameraSensor::create(shared->description, request, 1));

  const Rational step_rate = simulation->step_rate();
  const auto step_of = [&](int frame) {
    return static_cast<int64_t>(frame) * step_rate.num / (step_rate.den * options.rate);
  };
  PoseFrame now, previous;
  for (int i = 0; i < options.frames; ++i) {
    if (const int64_t ahead = step_of(i) - simulation->latest().step(); ahead > 0) {
      GLOAM_TRY_STATUS(simulation->step(ahead));
    }
    GLOAM_TRY_STATUS(solver->solve(simulation->latest(), now));
    const PoseFrame& before = i > 0 ? previous : now;
    const auto quick = fast->capture(*shared->renderer, shared->mutex, now, before, i);
    if (options.at.contains(i)) {
      const auto exact = path->capture(*shared->renderer, shared->mutex, now, before, i);
      for (const auto& [name, frame] : {std::pair{"fast", quick}, std::pair{"path", exact}}) {
        GLOAM_TRY_STATUS(
            write_file_atomic(fmt::format("{}/{}_{}.png", options.out, name, i),
                              encode_png8(options.width, options.height, 3, frame->rgb)));
      }
      fmt::print("frame {} mean {:.4f} {:.4f}\n", i, mean_luminance(*quick),
                 mean_luminance(*exact));
    }
    std::swap(now, previous);
  }
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool more = i + 1 < argc;
    if (word == "--size" && more) {
      std::sscanf(argv[++i], "%dx%d", &options.width, &options.height);
    } else if (word == "--rate" && more) {
      options.rate = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--frames" && more) {
      options.frames = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--spp" && more) {
      options.spp = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--at" && more) {
      for (char* at = argv[++i]; *at != 0; at += *at == ',') {
        options.at.insert(static_cast<int>(std::strtol(at, &at, 10)));
      }
    } else {
      words.emplace_back(word);
    }
  }
  if (words.size() != 3) {
    fmt::print(stderr,
               "usage: fast_pictures SCENE CAMERA OUT [--size WxH] [--rate HZ] [--frames N] "
               "[--at I,J] [--spp N]\n");
    return 2;
  }
  options.model = words[0], options.camera = words[1], options.out = words[2];
  if (options.at.empty()) options.at = {options.frames - 1};
  std::filesystem::create_directories(options.out);
  const gloam::Status status = gloam::run(options);
  if (!status) fmt::print(stderr, "gloam: error: {}\n", status.error().to_string());
  return status.ok() ? 0 : status.error().exit_code();
}

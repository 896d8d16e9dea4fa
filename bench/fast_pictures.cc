// Pictures of the fast tier, taken one after the other as a live camera does, and of the path tier
// at the same instants, for bench/fast_error.py to compare.
//
//   fast_pictures SCENE CAMERA OUT [--size WxH] [--rate HZ] [--frames N] [--at I,J …] [--spp N]
//                 [--seed N] [--references FOLDER]
//
// Writes OUT/fast_I.png and OUT/path_I.png for the frames I, J … (default: the last), and prints
// "frame I mean FAST PATH" with the mean luminance of both [cd/m²]. The path tier's picture is the
// mean of two with half of the samples each, half_0_I.png and half_1_I.png, which tell how much
// noise is left in it. In FOLDER they are kept for the next time.

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>

#include "base/files.h"
#include "base/hash.h"
#include "base/vec.h"
#include "bench/command_line.h"
#include "gloam/scene.h"
#include "render/film/png.h"
#include "render/film/tone_map.h"
#include "runtime/live_simulation.h"

namespace gloam {
namespace {

struct Options {
  std::string model, camera, out, references;
  int width = 320, height = 240, rate = 20, frames = 20, spp = 512;
  int seed = 1;  ///< of the fast tier
  std::set<int> at;
};

using Radiance = std::vector<float>;  // [cd/m²], (height x width x 3)

double mean_luminance(const Radiance& radiance) {
  double sum = 0;
  const size_t n = radiance.size() / 3;
  for (size_t i = 0; i < n; ++i) {
    sum += luminance(Vec3f{radiance[3 * i], radiance[3 * i + 1], radiance[3 * i + 2]});
  }
  return sum / static_cast<double>(n);
}

/// What takes pictures of one instant.
struct Studio {
  SharedRenderer& shared;
  CameraRequest request;

  Result<Radiance> path_picture(const PoseFrame& now, const PoseFrame& before, int spp,
                                uint64_t seed) const {
    CameraRequest path = request;
    path.render.tier = "path";
    path.render.spp = spp;
    path.render.denoise = false;  // it would move what is to be told from the fast tier's
    GLOAM_TRY(const auto sensor, CameraSensor::create(shared.description, path, seed));
    return sensor->capture(*shared.renderer, shared.turns, now, before, 0)->radiance;
  }
};

/// What tells a scene's references apart from others. The path tier has no bias, so they stay true
/// while its samples change.
Result<uint64_t> key_of(const Options& options) {
  GLOAM_TRY(const std::vector<uint8_t> text, read_file(options.model));
  const int taken[] = {options.width, options.height, options.rate, options.spp};
  return hash_span(std::span<const uint8_t>(text), hash_span(std::span<const int>(taken), 0));
}

/// Two independent pictures of the path tier with half of the samples each; those called `name` in
/// `folder` if they have been taken before.
Result<std::array<Radiance, 2>> references(const Studio& studio, const PoseFrame& now,
                                           const PoseFrame& before, int spp,
                                           const std::string& folder, const std::string& name) {
  std::array<Radiance, 2> halves;
  std::filesystem::path kept;
  if (!folder.empty()) {
    kept = std::filesystem::path(folder) / (name + ".f32");
    if (std::filesystem::exists(kept)) {
      GLOAM_TRY(const std::vector<uint8_t> bytes, read_file(kept));
      const auto values = static_cast<size_t>(studio.request.width * studio.request.height) * 3;
      const size_t size = values * sizeof(float);
      for (size_t i = 0; i < 2; ++i) {
        halves[i].resize(values);
        if (bytes.size() != 2 * size) {
          return Error{ErrorKind::kInput, kept.string() + " is cut short: remove it"};
        }
        std::memcpy(halves[i].data(), bytes.data() + i * size, size);
      }
      return halves;
    }
  }
  for (uint64_t i = 0; i < 2; ++i) {
    GLOAM_TRY(halves[i], studio.path_picture(now, before, std::max(1, spp / 2), 2 + i));
  }
  if (!folder.empty()) {
    Radiance both = halves[0];
    both.insert(both.end(), halves[1].begin(), halves[1].end());
    const auto* bytes = reinterpret_cast<const uint8_t*>(both.data());
    GLOAM_TRY_STATUS(make_folder(folder));
    GLOAM_TRY_STATUS(write_file_atomic(kept, {bytes, both.size() * sizeof(float)}));
  }
  return halves;
}

Status write_picture(const Options& options, const std::string& name, const Radiance& radiance,
                     float ev100) {
  std::vector<Vec3f> colors(radiance.size() / 3);
  for (size_t i = 0; i < colors.size(); ++i) {
    colors[i] = {radiance[3 * i], radiance[3 * i + 1], radiance[3 * i + 2]};
  }
  std::vector<uint8_t> rgb;
  tone_map(colors, options.width, options.height, {.ev100 = ev100}, &rgb);
  return write_file_atomic(fmt::format("{}/{}.png", options.out, name),
                           encode_png8(options.width, options.height, 3, rgb));
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
  request.outputs = {"radiance"};
  request.render = scene.render;
  const Studio studio{*shared, request};
  request.render.tier = "fast";
  GLOAM_TRY(const auto fast, CameraSensor::create(shared->description, request,
                                                  static_cast<uint64_t>(options.seed)));
  const auto ev100 = static_cast<float>(
      scene.render.ev100.value_or(static_cast<double>(shared->description.ev100)));

  GLOAM_TRY(const uint64_t key, key_of(options));
  const std::string stem = std::filesystem::path(options.model).stem().string();
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
    const auto quick = fast->capture(*shared->renderer, shared->turns, now, before, i);
    if (options.at.contains(i)) {
      GLOAM_TRY(const auto halves, references(studio, now, before, options.spp, options.references,
                                              fmt::format("{}_{}_{}", stem, hash_to_hex(key), i)));
      Radiance path = halves[0];
      for (size_t k = 0; k < path.size(); ++k) path[k] = 0.5f * (path[k] + halves[1][k]);
      GLOAM_TRY_STATUS(write_picture(options, fmt::format("fast_{}", i), quick->radiance, ev100));
      GLOAM_TRY_STATUS(write_picture(options, fmt::format("path_{}", i), path, ev100));
      for (int k = 0; k < 2; ++k) {
        GLOAM_TRY_STATUS(write_picture(options, fmt::format("half_{}_{}", k, i), halves[k], ev100));
      }
      fmt::print("frame {} mean {:.4f} {:.4f}\n", i, mean_luminance(quick->radiance),
                 mean_luminance(path));
    }
    std::swap(now, previous);
  }
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  gloam::CommandLine line(argc, argv);
  line.size(&options.width, &options.height);
  line.value("--rate", &options.rate);
  line.value("--frames", &options.frames);
  line.value("--spp", &options.spp);
  line.value("--seed", &options.seed);
  line.value("--references", &options.references);
  std::string frames;
  line.value("--at", &frames);
  for (char* at = frames.data(); *at != 0; at += *at == ',')
    options.at.insert(static_cast<int>(std::strtol(at, &at, 10)));
  const std::vector<std::string>& words = line.words();
  if (words.size() != 3) {
    fmt::print(stderr,
               "usage: fast_pictures SCENE CAMERA OUT [--size WxH] [--rate HZ] [--frames N] "
               "[--at I,J] [--spp N] [--seed N] [--references FOLDER]\n");
    return 2;
  }
  options.model = words[0], options.camera = words[1], options.out = words[2];
  if (options.at.empty()) options.at = {options.frames - 1};
  std::filesystem::create_directories(options.out);
  return gloam::exit_code(gloam::run(options));
}

// Means over blocks of pixels of a path-traced picture, in batches with seeds of their own: what
// bench/mitsuba compares with Mitsuba. Batches are independent of each other (the samples of one
// are not: their points are spread evenly), so their scatter tells the error of their mean.
//   path_blocks SCENE FILE [--camera NAME] [--spp N] [--batches N] [--seed N] [--block N]
// Size and depth are the scene's. FILE: a line of JSON, then float32 as in memory, linear Rec. 709
// [cd/m²]: (batches x rows x columns x 3) means of blocks, (height x width x 3) the mean picture.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "base/files.h"
#include "bench/command_line.h"
#include "gloam/scene.h"
#include "runtime/live/live_simulation.h"

using namespace gloam;

namespace {

struct Arguments {
  std::string scene, out, camera = "free";
  int spp = 16, batches = 16, block = 8;
  uint64_t seed = 1;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  CommandLine line(argc, argv);
  line.value("--camera", &a.camera);
  line.value("--spp", &a.spp);
  line.value("--batches", &a.batches);
  std::string seed;
  if (line.value("--seed", &seed)) a.seed = std::strtoull(seed.c_str(), nullptr, 10);
  line.value("--block", &a.block);
  if (line.words().size() == 2) a.scene = line.words()[0], a.out = line.words()[1];
  return a;
}

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Appends the means over whole blocks, row by row.
void add_blocks(const CameraFrame& frame, int block, std::vector<float>* out) {
  const int width = frame.intrinsics.width, height = frame.intrinsics.height;
  for (int y = 0; y + block <= height; y += block) {
    for (int x = 0; x + block <= width; x += block) {
      double sum[3] = {};
      for (int i = 0; i < block * block; ++i) {
        const size_t pixel = static_cast<size_t>(y + i / block) * width + (x + i % block);
        for (size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(frame.radiance[3 * pixel + k]);
      }
      for (const double s : sum) out->push_back(static_cast<float>(s / (block * block)));
    }
  }
}

Status render_blocks(const Arguments& a) {
  GLOAM_TRY(const Scene scene, load_scene(a.scene));
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(const auto simulation, LiveSimulation::create(world, {}));
  GLOAM_TRY(const auto shared, simulation->renderer());
  GLOAM_TRY(const auto solver, PoseSolver::create(world.compiled()));
  PoseFrame poses;
  GLOAM_TRY_STATUS(solver->solve(simulation->latest(), poses));

  CameraRequest request;
  request.camera = a.camera;
  request.outputs = {"radiance"};
  request.render = scene.render;
  request.render.tier = RenderTier::kPath;
  request.render.spp = a.spp;
  request.render.denoise = false;
  std::vector<float> blocks, picture;
  Intrinsics size;
  std::vector<double> seconds;
  for (int i = 0; i < a.batches; ++i) {
    const uint64_t seed = a.seed * 1000003 + static_cast<uint64_t>(i);
    GLOAM_TRY(const auto sensor, CameraSensor::create(shared->description, request, seed));
    const double before = cpu_seconds();
    const auto frame = sensor->capture(*shared->renderer, shared->turns, poses, poses, 0);
    seconds.push_back(cpu_seconds() - before);
    add_blocks(*frame, a.block, &blocks);
    picture.resize(frame->radiance.size());
    for (size_t k = 0; k < picture.size(); ++k) {
      picture[k] += frame->radiance[k] / static_cast<float>(a.batches);
    }
    size = frame->intrinsics;
  }
  const std::string header = fmt::format(
      "{{\"width\": {}, \"height\": {}, \"block\": {}, \"batches\": {}, \"spp\": {}, "
      "\"max_depth\": {}, \"cpu_seconds\": {:.3f}, \"cpu_of_batch\": {:.5f}}}\n",
      size.width, size.height, a.block, a.batches, a.spp, path_depth(request.render, false),
      cpu_seconds(), median(seconds));
  std::vector<uint8_t> bytes(header.begin(), header.end());
  for (const std::vector<float>* values : {&blocks, &picture}) {
    const auto* raw = reinterpret_cast<const uint8_t*>(values->data());
    bytes.insert(bytes.end(), raw, raw + values->size() * sizeof(float));
  }
  return write_file_atomic(a.out, bytes);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments a = parse(argc, argv);
  if (a.out.empty() || a.batches < 2) {
    std::fputs(
        "usage: path_blocks SCENE FILE [--camera NAME] [--spp N] [--batches N] [--seed N] "
        "[--block N]\n",
        stderr);
    return 2;
  }
  return exit_code(render_blocks(a));
}

// Time of an image of a realistic scene: a camera moves through it while physics runs.
//
//   realistic_rate SCENE --tier interactive|path|direct [--camera FROM..TO] [--size WxH]
//                  [--device auto|cpu|cuda] [--frames N] [--spp N] [--out FOLDER] [--json]
//
// Physics steps between the images, 20 of them per second of simulation time, and is timed apart:
// its time is a mean over the intervals, because one of them may hold all work of a second. The
// time of an image is the wall time from the simulation's state to the finished RGB image: poses,
// update of the scene, rendering, filter, tone map. `first`: from the compiled scene to the first
// image, that is to say with the preparation of the renderer. FOLDER gets the images.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "bench/command_line.h"
#include "bench/median.h"
#include "bench/moving_scene.h"
#include "render/film/png.h"

namespace gloam {
namespace {

constexpr int kRate = 20;  // images per second of simulation time

struct Options {
  std::string scene, tier, camera = "from..to", device, out;
  int width = 640, height = 480, frames = 20, spp = 1;
  bool json = false;
};

/// Wall times [ms].
struct Times {
  double load = 0;                            ///< of the scene file until it is compiled
  double renderer = 0;                        ///< from there until the renderer is ready
  double first = 0;                           ///< the same, and the first image
  std::vector<double> images, physics, rays;  ///< after the first image
  std::vector<double> device, upload;         ///< of these images on the card, and the scene's copy
};

/// Milliseconds since the last call.
class Watch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double, std::milli> passed = now - since_;
    since_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

Status write(const Options& options, int index, const CameraFrame& frame) {
  if (options.out.empty()) return {};
  const std::string stem = std::filesystem::path(options.scene).stem().string();
  GLOAM_TRY_STATUS(make_folder(options.out));
  return write_file_atomic(
      fmt::format("{}/{}_{}_{:03}.png", options.out, stem, options.tier, index),
      encode_png8(options.width, options.height, 3, frame.rgb));
}

Result<std::unique_ptr<CameraSensor>> open(const Options& options, const MovingScene& scene,
                                           const RenderOptions& render, const BenchCamera& camera) {
  CameraRequest request;
  request.camera = camera.name();
  request.width = options.width, request.height = options.height;
  request.render = render;
  GLOAM_TRY(request.render.tier, enum_named<RenderTier>(options.tier));
  request.render.spp = options.spp;
  request.render.error.reset();
  request.X_WC = camera.pose_at(0);
  return CameraSensor::create(scene.shared->description, request, 1);
}

Result<Times> measure(const Options& options) {
  Times times;
  Watch watch;
  GLOAM_TRY(Scene file, load_scene(options.scene));
  if (!options.device.empty()) {
    GLOAM_TRY(file.render.device, enum_named<RenderDevice>(options.device));
  }
  GLOAM_TRY(const auto scene, MovingScene::compile(file));
  times.load = watch.lap();
  GLOAM_TRY_STATUS(scene->open_renderer());
  times.renderer = watch.lap();
  GLOAM_TRY_STATUS(scene->solve());
  GLOAM_TRY(const auto camera, BenchCamera::find(*scene, options.camera));
  GLOAM_TRY(const auto sensor, open(options, *scene, file.render, camera));
  SharedRenderer& shared = *scene->shared;
  for (int i = 0; i < options.frames; ++i) {
    if (i > 0) {
      watch.lap();
      GLOAM_TRY_STATUS(scene->step_to(i, kRate));
      times.physics.push_back(watch.lap());
      GLOAM_TRY_STATUS(scene->solve());
    }
    const auto pose = camera.pose_at(static_cast<double>(i) / kRate);
    if (pose) sensor->set_free_pose(*pose);
    const auto frame =
        sensor->capture(*shared.renderer, shared.turns, scene->now, scene->previous, i);
    const double image = watch.lap();
    if (i == 0) {
      times.first = times.renderer + image;
    } else {
      times.images.push_back(image);
      times.rays.push_back(static_cast<double>(sensor->stats().rays));
      times.device.push_back(1e3 * sensor->stats().device_seconds);
      times.upload.push_back(1e3 * sensor->stats().upload_seconds);
    }
    GLOAM_TRY_STATUS(write(options, i, *frame));
  }
  return times;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// The least value that 95 % of them do not exceed.
double percentile_95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[(values.size() * 95 + 99) / 100 - 1];
}

Status run(const Options& options) {
  GLOAM_TRY(const Times times, measure(options));
  const double physics = mean(times.physics);
  const std::string name = std::filesystem::path(options.scene).stem().string();
  constexpr const char* kJson =
      "{{\"scene\": \"{}\", \"tier\": \"{}\", \"width\": {}, \"height\": {}, \"frames\": {}, "
      "\"image_ms\": {:.3f}, \"image_p95_ms\": {:.3f}, \"first_ms\": {:.3f}, "
      "\"renderer_ms\": {:.3f}, \"load_ms\": {:.3f}, \"physics_ms\": {:.3f}, "
      "\"real_time_factor\": {:.4f}, \"rays\": {:.0f}, \"device_ms\": {:.3f}, "
      "\"upload_ms\": {:.3f}}}\n";
  constexpr const char* kText =
      "{}, {} tier, {}x{}, {} images\n"
      "  image    {:8.1f} ms median, {:.1f} ms 95th percentile\n"
      "  first    {:8.1f} ms, of which {:.1f} ms until the renderer is ready\n"
      "  load     {:8.1f} ms before\n"
      "  physics  {:8.1f} ms per image, {:.2f} x real time\n"
      "  rays     {:8.0f} per image\n"
      "  card     {:8.3f} ms, copy of the scene before {:.3f} ms\n";
  fmt::print(fmt::runtime(options.json ? kJson : kText), name, options.tier, options.width,
             options.height, options.frames, median(times.images), percentile_95(times.images),
             times.first, times.renderer, times.load, physics, 1e3 / kRate / physics,
             median(times.rays), median(times.device), median(times.upload));
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  gloam::CommandLine line(argc, argv);
  const bool help = line.flag("--help");
  options.json = line.flag("--json");
  line.value("--tier", &options.tier);
  line.value("--camera", &options.camera);
  line.size(&options.width, &options.height);
  line.value("--device", &options.device);
  line.value("--frames", &options.frames, 2);
  line.value("--spp", &options.spp);
  line.value("--out", &options.out);
  if (help || line.words().size() != 1 || options.tier.empty()) {
    fmt::print(
        help ? stdout : stderr,
        "usage: realistic_rate SCENE --tier interactive|path|direct [--camera FROM..TO] "
        "[--size WxH] [--device auto|cpu|cuda] [--frames N] [--spp N] [--out FOLDER] [--json]\n");
    return help ? 0 : 2;
  }
  options.scene = line.words()[0];
  return gloam::exit_code(gloam::run(options));
}

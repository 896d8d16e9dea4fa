// Mean radiance of pictures with few samples, of the path tier (denoised) and of the interactive
// tier, relative to pictures with many samples (not denoised); and the spread between pictures of
// the same instant.
//
//   few_samples SCENE… [--time S] [--size WxH] [--spp N] [--seeds N] [--pictures FOLDER] [--json]

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "bench/command_line.h"
#include "gloam/scene.h"
#include "render/film/png.h"
#include "render/film/tone_map.h"
#include "runtime/live/live_simulation.h"
#include "runtime/live/run_to_step.h"
#include "sensors/camera/camera_sensor.h"

namespace gloam {
namespace {

struct Options {
  std::string time = "2", pictures;
  int width = 96, height = 72;
  int spp = 256;  ///< of the converged picture
  int seeds = 4;  ///< pictures of few samples
  bool json = false;
};

constexpr int kRounds = 8;            // parts of the converged picture, for its standard error
constexpr int kFew[] = {4, 16};       // samples
constexpr int kFrames = 8;            // of the still scene
constexpr uint64_t kManySeeds = 900;  // first seed of the converged picture

using Picture = std::vector<Vec3f>;   // [cd/m²]
using Color = std::array<double, 3>;  // Rec. 709

Color mean_of(const Picture& picture) {
  Color sum{};
  for (const Vec3f& p : picture) {
    for (int c = 0; c < 3; ++c) sum[static_cast<size_t>(c)] += static_cast<double>(p[c]);
  }
  for (double& s : sum) s /= static_cast<double>(picture.size());
  return sum;
}

/// Mean of several pictures' means, and its standard error.
struct Estimate {
  Color mean{}, error{};

  static Estimate of(const std::vector<Color>& values) {
    Estimate e;
    const auto n = static_cast<double>(values.size());
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0, squares = 0;
      for (const Color& v : values) sum += v[c];
      e.mean[c] = sum / n;
      for (const Color& v : values) squares += (v[c] - e.mean[c]) * (v[c] - e.mean[c]);
      e.error[c] = n > 1 ? std::sqrt(squares / (n * (n - 1))) : 0;
    }
    return e;
  }
  /// With the relative errors of both.
  Estimate over(const Estimate& whole) const {
    Estimate e;
    for (size_t c = 0; c < 3; ++c) {
      const double r = mean[c] / std::max(whole.mean[c], 1e-12);
      e.mean[c] = r;
      e.error[c] = r * std::hypot(error[c] / std::max(mean[c], 1e-12),
                                  whole.error[c] / std::max(whole.mean[c], 1e-12));
    }
    return e;
  }
};

/// Cameras' pictures of one instant.
struct Studio {
  SharedRenderer& shared;
  CameraRequest request;
  PoseFrame now;
  float ev100 = 0;

  /// The pictures of `frames` frames, as a camera takes them that sees this instant again and
  /// again.
  Result<std::vector<Picture>> take(const RenderOptions& render, uint64_t seed, int frames) const {
    CameraRequest asked = request;
    asked.render = render;
    GLOAM_TRY(const auto sensor, CameraSensor::create(shared.description, asked, seed));
    std::vector<Picture> pictures;
    for (int i = 0; i < frames; ++i) {
      const auto frame = sensor->capture(*shared.renderer, shared.turns, now, now, i);
      Picture& picture = pictures.emplace_back(frame->radiance.size() / 3);
      for (size_t k = 0; k < picture.size(); ++k) {
        const float* p = &frame->radiance[3 * k];
        picture[k] = {p[0], p[1], p[2]};
      }
    }
    return pictures;
  }
  RenderOptions render(int spp, bool denoise, RenderTier tier = RenderTier::kPath) const {
    RenderOptions r = request.render;
    r.tier = tier;
    r.spp = spp;
    r.error.reset();
    r.denoise = denoise;
    return r;
  }
  std::vector<uint8_t> shown(const Picture& picture) const {
    std::vector<uint8_t> rgb;
    tone_map(picture, request.width, request.height, {.ev100 = ev100}, &rgb);
    return rgb;
  }
};

/// Mean over pixels of a value's standard deviation over the pictures [1/255 of the display].
double deviation(const Studio& studio, const std::vector<Picture>& pictures) {
  std::vector<double> sum, squares;
  const auto n = static_cast<double>(pictures.size());
  for (const Picture& picture : pictures) {
    const std::vector<uint8_t> rgb = studio.shown(picture);
    sum.resize(rgb.size());
    squares.resize(rgb.size());
    for (size_t i = 0; i < rgb.size(); ++i) {
      sum[i] += rgb[i];
      squares[i] += double{1} * rgb[i] * rgb[i];
    }
  }
  double total = 0;
  for (size_t i = 0; i < sum.size(); ++i)
    total += std::sqrt(std::max(0.0, squares[i] - sum[i] * sum[i] / n) / (n - 1));
  return total / static_cast<double>(sum.size());
}

struct Found {
  Estimate many;                         ///< [cd/m²]
  std::map<std::string, Estimate> few;   ///< over it, by tier and samples
  std::map<std::string, Estimate> kept;  ///< denoised over the same samples as they are
  double deviation = 0;
};

Status save(const Options& options, const Studio& studio, const std::string& name,
            const Picture& picture) {
  if (options.pictures.empty()) return {};
  GLOAM_TRY_STATUS(make_folder(options.pictures));
  return write_file_atomic(
      fmt::format("{}/{}.png", options.pictures, name),
      encode_png8(studio.request.width, studio.request.height, 3, studio.shown(picture)));
}

Result<Found> measure(const Options& options, const Studio& studio, const std::string& name) {
  Found found;
  std::vector<Color> means;
  Picture many(static_cast<size_t>(options.width) * static_cast<size_t>(options.height));
  for (int i = 0; i < kRounds; ++i) {
    GLOAM_TRY(const auto part, studio.take(studio.render(options.spp / kRounds, false),
                                           kManySeeds + static_cast<uint64_t>(i), 1));
    means.push_back(mean_of(part[0]));
    for (size_t k = 0; k < many.size(); ++k) many[k] += part[0][k] / float{kRounds};
  }
  found.many = Estimate::of(means);
  GLOAM_TRY_STATUS(save(options, studio, name + "_many", many));
  for (const int spp : kFew) {
    std::vector<Color> clean, raw;
    for (int i = 0; i < options.seeds; ++i) {
      const auto seed = static_cast<uint64_t>(1 + i);
      GLOAM_TRY(const auto denoised, studio.take(studio.render(spp, true), seed, 1));
      GLOAM_TRY(const auto samples, studio.take(studio.render(spp, false), seed, 1));
      clean.push_back(mean_of(denoised[0]));
      raw.push_back(mean_of(samples[0]));
      if (i == 0)
        GLOAM_TRY_STATUS(save(options, studio, fmt::format("{}_{}", name, spp), denoised[0]));
    }
    const std::string key = fmt::format("path {}", spp);
    found.few[key] = Estimate::of(clean).over(found.many);
    std::vector<Color> kept(clean.size());
    for (size_t i = 0; i < kept.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) kept[i][c] = clean[i][c] / std::max(raw[i][c], 1e-12);
    }
    found.kept[key] = Estimate::of(kept);
  }
  std::vector<Color> interactive;
  for (int i = 0; i < options.seeds; ++i) {
    GLOAM_TRY(const auto frames, studio.take(studio.render(1, true, RenderTier::kInteractive),
                                             static_cast<uint64_t>(1 + i), kFrames));
    interactive.push_back(mean_of(frames.back()));
    if (i == 0) GLOAM_TRY_STATUS(save(options, studio, name + "_fast", frames.back()));
  }
  found.few["interactive"] = Estimate::of(interactive).over(found.many);
  GLOAM_TRY(const auto still, studio.take(studio.render(16, true), 1, kFrames));
  found.deviation = deviation(studio, still);
  return found;
}

std::string text_of(const Color& c, const char* separator) {
  return fmt::format("{1:.4g}{0}{2:.4g}{0}{3:.4g}", separator, c[0], c[1], c[2]);
}

void print(const std::string& name, const Found& found, bool json) {
  std::string rows;
  for (const auto& [key, ratio] : found.few) {
    const auto kept = found.kept.find(key);
    if (json) {
      rows += fmt::format(", \"{}\": {{\"ratio\": [{}], \"error\": [{}]", key,
                          text_of(ratio.mean, ", "), text_of(ratio.error, ", "));
      if (kept != found.kept.end())
        rows += fmt::format(", \"kept\": [{}]", text_of(kept->second.mean, ", "));
      rows += '}';
    } else {
      rows +=
          fmt::format("  {}: {} (± {})", key, text_of(ratio.mean, "/"), text_of(ratio.error, "/"));
      if (kept != found.kept.end())
        rows += fmt::format(", of its samples {}", text_of(kept->second.mean, "/"));
      rows += '\n';
    }
  }
  const char* text = json ? "{{\"scene\": \"{}\", \"many\": [{}], \"error\": [{}]{}, "
                            "\"still\": {:.3f}}}\n"
                          : "{}: {} cd/m² (± {})\n{}  still: {:.2f}/255\n";
  fmt::print(fmt::runtime(text), name, text_of(found.many.mean, json ? ", " : "/"),
             text_of(found.many.error, json ? ", " : "/"), rows, found.deviation);
  std::fflush(stdout);
}

Status run(const Options& options, const std::string& file) {
  GLOAM_TRY(const Scene scene, load_scene(file));
  GLOAM_TRY(const World world, World::compile(scene));
  GLOAM_TRY(const auto simulation, LiveSimulation::create(world, {.pace = Pace::kLockstep},
                                                          {.metering = Metering::kNever}));
  GLOAM_TRY(const auto shared, simulation->renderer());
  GLOAM_TRY(const int64_t steps,
            step_of_time(std::atof(options.time.c_str()), simulation->step_rate(), "a time"));
  GLOAM_TRY_STATUS(simulation->step(steps));
  GLOAM_TRY(const auto solver, PoseSolver::create(world.compiled()));
  CameraRequest request;
  request.camera = simulation->camera_names().front();
  request.width = options.width, request.height = options.height;
  request.outputs = {"radiance"};
  request.render = scene.render;
  Studio studio{*shared, request, {}, 0};
  GLOAM_TRY_STATUS(solver->solve(simulation->latest(), studio.now));
  studio.ev100 = static_cast<float>(
      scene.render.ev100.value_or(static_cast<double>(shared->description.ev100)));
  const std::string name = std::filesystem::path(file).stem().string();
  GLOAM_TRY(const Found found, measure(options, studio, name));
  print(name, found, options.json);
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::Options options;
  gloam::CommandLine line(argc, argv);
  options.json = line.flag("--json");
  line.value("--time", &options.time);
  line.size(&options.width, &options.height);
  line.value("--spp", &options.spp, gloam::kRounds);
  line.value("--seeds", &options.seeds);
  line.value("--pictures", &options.pictures);
  if (line.words().empty()) {
    fmt::print(stderr,
               "usage: few_samples SCENE… [--time S] [--size WxH] [--spp N] [--seeds N] "
               "[--pictures FOLDER] [--json]\n");
    return 2;
  }
  for (const std::string& file : line.words()) {
    if (const gloam::Status status = gloam::run(options, file); !status.ok())
      return gloam::exit_code(status);
  }
  return 0;
}

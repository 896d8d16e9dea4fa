// Pictures of the interactive tier, taken one after the other as a live camera does, and of the
// path tier at the same instants, for bench/interactive_error.py to compare.
//
//   interactive_pictures SCENE CAMERA OUT [--size WxH] [--rate HZ] [--frames N] [--at I,J …]
//                 [--spp N] [--seed N] [--references FOLDER]
//
// CAMERA is one of the scene's, or FROM..TO: the free camera on its way from one to the other.
// Writes OUT/interactive_I.png and OUT/path_I.png for the frames I, J … (default: the last), and
// prints "frame I mean R G B / R G B" with the mean radiance of the interactive and the path tier
// [cd/m²]. The path tier's picture is the mean of two with half of the samples each, half_0_I.png
// and half_1_I.png, whose difference shows its noise. Both halves have long paths and are denoised,
// which keeps their means. FOLDER keeps the references for later runs.

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
#include "bench/moving_scene.h"
#include "render/film/png.h"
#include "render/film/tone_map.h"

namespace gloam {
namespace {

struct Options {
  std::string model, camera, out, references;
  int width = 320, height = 240, rate = 20, frames = 20, spp = 512;
  int seed = 1;  ///< of the interactive tier
  std::set<int> at;
};

/// Path vertices of references: the default of five leaves out light that the interactive tier's
/// cache carries.
constexpr int kReferenceDepth = 24;

using Radiance = std::vector<float>;  // [cd/m²], (height x width x 3)

/// "R G B" of the mean over the pixels.
std::string mean_of(const Radiance& radiance) {
  std::array<double, 3> sum{};
  for (size_t i = 0; i < radiance.size(); ++i) sum[i % 3] += static_cast<double>(radiance[i]);
  const auto n = static_cast<double>(radiance.size() / 3);
  return fmt::format("{:.6g} {:.6g} {:.6g}", sum[0] / n, sum[1] / n, sum[2] / n);
}

/// Takes pictures of the scene at one instant.
struct Studio {
  const MovingScene& scene;
  CameraRequest request;  ///< of the path tier

  Result<Radiance> path_picture(int spp, uint64_t seed) const {
    CameraRequest path = request;
    path.render.spp = spp;
    GLOAM_TRY(const auto sensor, CameraSensor::create(scene.shared->description, path, seed));
    return sensor
        ->capture(*scene.shared->renderer, scene.shared->turns, scene.now, scene.previous, 0)
        ->radiance;
  }
};

/// Key of a scene's references on disk, from its file and the options. The generated place does not
/// contribute, since its last bits depend on the machine's C library.
Result<uint64_t> key_of(const Options& options) {
  GLOAM_TRY(const std::vector<uint8_t> text, read_file(options.model));
  const int taken[] = {options.width, options.height, options.rate, options.spp, kReferenceDepth};
  const uint64_t camera = hash_bytes(options.camera.data(), options.camera.size());
  return hash_span(std::span<const uint8_t>(text), hash_span(std::span<const int>(taken), camera));
}

/// Two independent pictures of the path tier with half of the samples each; those called `name` in
/// `folder` if they have been taken before.
Result<std::array<Radiance, 2>> references(const Studio& studio, int spp, const std::string& folder,
                                           const std::string& name) {
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
  fmt::print(stderr, "rendering the reference {} with {} samples\n", name, spp);
  for (uint64_t i = 0; i < 2; ++i) {
    GLOAM_TRY(halves[i], studio.path_picture(std::max(1, spp / 2), 2 + i));
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

/// Both tiers' pictures of one instant, and their means.
Status compare(const Options& options, const Studio& studio, const std::string& name, int frame,
               const Radiance& interactive) {
  const RenderDescription& description = studio.scene.shared->description;
  const auto ev100 = static_cast<float>(
      studio.request.render.ev100.value_or(static_cast<double>(description.ev100)));
  GLOAM_TRY(const auto halves, references(studio, options.spp, options.references, name));
  Radiance path = halves[0];
  for (size_t k = 0; k < path.size(); ++k) path[k] = 0.5f * (path[k] + halves[1][k]);
  GLOAM_TRY_STATUS(
      write_picture(options, fmt::format("interactive_{}", frame), interactive, ev100));
  GLOAM_TRY_STATUS(write_picture(options, fmt::format("path_{}", frame), path, ev100));
  for (size_t k = 0; k < 2; ++k)
    GLOAM_TRY_STATUS(write_picture(options, fmt::format("half_{}_{}", k, frame), halves[k], ev100));
  fmt::print("frame {} mean {} / {}\n", frame, mean_of(interactive), mean_of(path));
  return {};
}

Status run(const Options& options) {
  GLOAM_TRY(const Scene file, load_scene(options.model));
  GLOAM_TRY(const auto scene, MovingScene::compile(file));
  GLOAM_TRY_STATUS(scene->open_renderer());
  GLOAM_TRY_STATUS(scene->solve());
  GLOAM_TRY(const auto camera, BenchCamera::find(*scene, options.camera));
  CameraRequest request;
  request.camera = camera.name();
  request.width = options.width, request.height = options.height;
  request.outputs = {"radiance"};
  request.render = file.render;
  request.render.tier = RenderTier::kInteractive;
  SharedRenderer& shared = *scene->shared;
  GLOAM_TRY(const auto interactive,
            CameraSensor::create(shared.description, request, static_cast<uint64_t>(options.seed)));
  request.render.tier = RenderTier::kPath;
  request.render.error.reset();
  request.render.max_depth = kReferenceDepth;
  request.render.denoise = true;
  Studio studio{*scene, request};
  GLOAM_TRY(const uint64_t key, key_of(options));
  const std::string stem = std::filesystem::path(options.model).stem().string();
  for (int i = 0; i < options.frames; ++i) {
    GLOAM_TRY_STATUS(scene->step_to(i, options.rate));
    if (i > 0) GLOAM_TRY_STATUS(scene->solve());
    studio.request.X_WC = camera.pose_at(static_cast<double>(i) / options.rate);
    if (studio.request.X_WC) interactive->set_free_pose(*studio.request.X_WC);
    const auto picture =
        interactive->capture(*shared.renderer, shared.turns, scene->now, scene->previous, i);
    if (!options.at.contains(i)) continue;
    GLOAM_TRY_STATUS(compare(options, studio, fmt::format("{}_{}_{}", stem, hash_to_hex(key), i), i,
                             picture->radiance));
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
               "usage: interactive_pictures SCENE CAMERA OUT [--size WxH] [--rate HZ] [--frames N] "
               "[--at I,J] [--spp N] [--seed N] [--references FOLDER]\n"
               "CAMERA is a name or FROM..TO\n");
    return 2;
  }
  options.model = words[0], options.camera = words[1], options.out = words[2];
  if (options.at.empty()) options.at = {options.frames - 1};
  std::filesystem::create_directories(options.out);
  return gloam::exit_code(gloam::run(options));
}

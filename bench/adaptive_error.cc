// Accuracy of adaptive sampling: the true error of its pictures, from renders that differ only in
// their seed, against the requested error; and the ratio of samples that uniform sampling needs for
// the same error.
//   adaptive_error [--error E] [--spp MOST] [--size WxH] [--seeds N] [--scene NAME] [--json]
//     [--pictures FOLDER]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/files.h"
#include "bench/command_line.h"
#include "render/film/png.h"
#include "render/film/tone_map.h"
#include "render/test/adaptive_scenes.h"

using namespace gloam;

namespace {

struct Arguments {
  double error = 0.05;
  int spp = 4096, width = 128, height = 96, seeds = 8;
  bool json = false;
  std::string pictures, scene;  // empty = all
};

/// Of each pixel over renders with different seeds.
struct Measured {
  std::vector<Vec3f> mean, variance;
  double samples = 0;    ///< drawn per pixel, mean
  double unreached = 0;  ///< share of the picture
  Film last;
};

Measured measure(Renderer* renderer, const NoiseScene& scene, RenderSettings settings, int seeds) {
  Measured m;
  const double pixels = static_cast<double>(scene.view.intrinsics.width) *
                        static_cast<double>(scene.view.intrinsics.height);
  for (int k = 0; k < seeds; ++k) {
    settings.seed = 1000 + static_cast<uint64_t>(k);
    const RenderStats stats = renderer->render(scene.view, settings, &m.last);
    m.samples += static_cast<double>(stats.paths) / pixels / seeds;
    m.unreached += static_cast<double>(stats.unreached) / pixels / seeds;
    m.mean.resize(m.last.radiance.size());
    m.variance.resize(m.last.radiance.size());
    for (size_t i = 0; i < m.mean.size(); ++i) {
      const Vec3f delta = m.last.radiance[i] - m.mean[i];
      m.mean[i] += delta / static_cast<float>(k + 1);
      m.variance[i] += delta * (m.last.radiance[i] - m.mean[i]) / static_cast<float>(seeds - 1);
    }
  }
  return m;
}

/// Root mean square of the pixels' errors as render/cpu/path/adaptive_tile.h defines them, relative
/// to the values of `reference`.
double true_error(const Measured& m, const std::vector<Vec3f>& reference, float floor) {
  double sum = 0;
  for (size_t i = 0; i < m.mean.size(); ++i) {
    const Vec3f v = m.variance[i], r = reference[i];
    const double value = std::max((r.x + r.y + r.z) / 3, floor);
    sum += (v.x + v.y + v.z) / 3 / (value * value);
  }
  return std::sqrt(sum / static_cast<double>(m.mean.size()));
}

void save(const std::string& file, const Film& film, const std::vector<uint8_t>& rgb) {
  const Status written = write_file_atomic(file, encode_png8(film.width, film.height, 3, rgb));
  if (!written.ok()) std::fprintf(stderr, "%s\n", written.error().to_string().c_str());
}

void write_picture(const std::string& file, const Film& film, float white) {
  std::vector<uint8_t> rgb;
  tone_map(film.radiance, film.width, film.height, {.ev100 = std::log2(white / 1.02f)}, &rgb);
  save(file, film, rgb);
}

void write_counts(const std::string& file, const Film& film, int most) {
  std::vector<uint8_t> grey;
  for (const uint32_t n : film.sample_count) {
    const double share = std::log2(static_cast<double>(n) / 8) / std::log2(most / 8.0);
    for (int c = 0; c < 3; ++c) grey.push_back(static_cast<uint8_t>(std::lround(255 * share)));
  }
  save(file, film, grey);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  CommandLine line(argc, argv);
  a.json = line.flag("--json");
  std::string error;
  if (line.value("--error", &error)) a.error = std::atof(error.c_str());
  line.value("--spp", &a.spp);
  line.value("--seeds", &a.seeds);
  line.size(&a.width, &a.height);
  line.value("--pictures", &a.pictures);
  line.value("--scene", &a.scene);
  for (const NoiseScene& scene : noise_scenes(a.width, a.height)) {
    if (!a.scene.empty() && a.scene != scene.name) continue;
    auto renderer = scene.builder.make();
    RenderSettings settings;
    settings.exact_channels = false;
    settings.max_depth = 6;
    settings.roulette_depth = 2;
    settings.spp = a.spp;
    settings.error = static_cast<float>(a.error);
    settings.error_floor = scene.floor;
    const Measured ours = measure(renderer.get(), scene, settings, a.seeds);
    // Even pictures of the two powers of two around as many samples; errors in between follow a
    // power law.
    settings.error = 0;
    const double log2_samples = std::log2(ours.samples);
    const int low = std::max(2, static_cast<int>(log2_samples));
    settings.spp = 1 << low;
    const Measured fewer = measure(renderer.get(), scene, settings, a.seeds);
    settings.spp = 2 << low;
    const Measured more = measure(renderer.get(), scene, settings, a.seeds);
    const std::vector<Vec3f>& reference = more.mean;
    const double reached = true_error(ours, reference, scene.floor);
    const double e0 = true_error(fewer, reference, scene.floor);
    const double e1 = true_error(more, reference, scene.floor);
    const double even = e0 * std::pow(e1 / e0, log2_samples - low);
    const double gain = even * even / (reached * reached);
    std::printf(a.json ? "{\"scene\": \"%s\", \"reached\": %.5f, \"samples\": %.1f, "
                         "\"unreached\": %.4f, \"even_error\": %.5f, \"gain\": %.3f}\n"
                       : "%-8s error %.4f at %.0f samples per pixel (%.1f %% of the picture not "
                         "reached); even %.4f; gain %.2f\n",
                scene.name, reached, ours.samples, a.json ? ours.unreached : 100 * ours.unreached,
                even, gain);
    if (!a.pictures.empty()) {
      write_picture(a.pictures + "/" + scene.name + ".png", ours.last, 20 * scene.floor);
      write_picture(a.pictures + "/" + scene.name + "_even.png", fewer.last, 20 * scene.floor);
      write_counts(a.pictures + "/" + scene.name + "_samples.png", ours.last, a.spp);
    }
  }
}

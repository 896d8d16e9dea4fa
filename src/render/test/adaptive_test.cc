// Adaptive sampling: unbiased, as good as asked for, cheaper than even sampling, reproducible.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/test/adaptive_scenes.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

RenderSettings adaptive(const NoiseScene& scene, float error, int most) {
  RenderSettings s;
  s.spp = most;
  s.error = error;
  s.error_floor = scene.floor;
  s.max_depth = 6;
  s.roulette_depth = 3;
  s.exact_channels = false;
  return s;
}

float grey(Vec3f c) { return (c.x + c.y + c.z) / 3; }

/// Means over blocks of pixels, and their standard errors from render to render.
struct BlockMeans {
  static constexpr int kSide = 8;
  std::vector<Mean> blocks;
  Mean picture;
};

BlockMeans over_seeds(const NoiseScene& scene, RenderSettings settings, int seeds, uint64_t first) {
  auto renderer = scene.builder.make();
  BlockMeans out;
  Film film;
  for (int k = 0; k < seeds; ++k) {
    settings.seed = first + static_cast<uint64_t>(k);
    renderer->render(scene.view, settings, &film);
    const int columns = film.width / BlockMeans::kSide, rows = film.height / BlockMeans::kSide;
    out.blocks.resize(static_cast<size_t>(columns) * rows);
    double total = 0;
    for (int b = 0; b < columns * rows; ++b) {
      double sum = 0;
      for (int i = 0; i < BlockMeans::kSide * BlockMeans::kSide; ++i) {
        const int x = b % columns * BlockMeans::kSide + i % BlockMeans::kSide;
        const int y = b / columns * BlockMeans::kSide + i / BlockMeans::kSide;
        sum += grey(film.radiance[static_cast<size_t>(y) * film.width + x]);
      }
      out.blocks[static_cast<size_t>(b)].add(sum);
      total += sum;
    }
    out.picture.add(total);
  }
  return out;
}

double z_of(const Mean& a, const Mean& b) {
  return (a.mean - b.mean) / std::hypot(a.standard_error(), b.standard_error());
}

TEST(Adaptive, HasTheMeanOfEvenSampling) {
  // Rare bright paths and few samples: where a count that listens to its own samples goes wrong.
  const NoiseScene scene = caustic_scene(32, 24);
  const BlockMeans ours = over_seeds(scene, adaptive(scene, 0.15f, 256), 200, 1);
  RenderSettings even = adaptive(scene, 0, 256);
  const BlockMeans reference = over_seeds(scene, even, 100, 1000000);
  const double power =
      std::hypot(ours.picture.standard_error(), reference.picture.standard_error()) /
      reference.picture.mean;
  EXPECT_LT(power, 5e-3) << "too few samples to see a bias";
  EXPECT_LT(std::abs(z_of(ours.picture, reference.picture)), 3)
      << ours.picture.mean << " against " << reference.picture.mean;
  double squares = 0;
  for (size_t b = 0; b < ours.blocks.size(); ++b) {
    const double z = z_of(ours.blocks[b], reference.blocks[b]);
    EXPECT_LT(std::abs(z), 4) << "block " << b;
    squares += z * z;
  }
  EXPECT_LT(squares / static_cast<double>(ours.blocks.size()), 2)
      << "of the squared z of all blocks";
}

TEST(Adaptive, ReachesWhatIsAskedFor) {
  constexpr int kSeeds = 4, kWidth = 96, kHeight = 64;
  for (const NoiseScene& scene : noise_scenes(kWidth, kHeight)) {
    auto renderer = scene.builder.make();
    const auto error_of = [&](RenderSettings settings, double* samples) {
      std::vector<Mean> pixels(kWidth * kHeight);
      Film film;
      *samples = 0;
      for (int k = 0; k < kSeeds; ++k) {
        settings.seed = 50 + static_cast<uint64_t>(k);
        const RenderStats stats = renderer->render(scene.view, settings, &film);
        *samples += static_cast<double>(stats.paths) / (kWidth * kHeight * kSeeds);
        for (size_t i = 0; i < pixels.size(); ++i) pixels[i].add(grey(film.radiance[i]));
      }
      double sum = 0;
      for (const Mean& pixel : pixels) {
        const double value = std::max<double>(pixel.mean, scene.floor);
        sum += pixel.squares / (kSeeds - 1) / (value * value);
      }
      return std::sqrt(sum / static_cast<double>(pixels.size()));
    };
    double samples = 0, even_samples = 0;
    const std::string name = scene.name;
    const float error = name == "yard" ? 0.02f : 0.2f;
    const double reached = error_of(adaptive(scene, error, name == "yard" ? 4096 : 1024), &samples);
    if (name == "caustic") {  // rare bright paths: better than asked for, or little worse
      EXPECT_LT(reached / error, 1.3);
    } else {
      EXPECT_NEAR(reached / error, 1, 0.3) << name;
    }
    if (name != "yard") continue;
    // Most of that picture has no noise: fewer samples are enough.
    const int as_many = static_cast<int>(samples + 1);
    const double even = error_of(adaptive(scene, 0, as_many), &even_samples);
    EXPECT_LT(reached * reached, 0.9 * even * even) << "at " << samples << " samples per pixel";
  }
}

TEST(Adaptive, IsTheSamePictureForAnyNumberOfThreads) {
  const NoiseScene scene = lamp_scene(70, 41);
  RenderSettings settings = adaptive(scene, 0.2f, 128);
  settings.variance = settings.exact_channels = true;
  const int threads = thread_count();
  set_thread_count(1);
  const Film one = scene.builder.render(scene.view, settings);
  set_thread_count(threads > 1 ? threads : 3);
  settings.progress = [](double) { return true; };  // in another order of tiles
  const Film many = scene.builder.render(scene.view, settings);
  set_thread_count(0);
  const auto bytes = [](const auto& plane) {
    const auto* first = reinterpret_cast<const unsigned char*>(plane.data());
    return std::vector<unsigned char>(first, first + plane.size() * sizeof(plane[0]));
  };
  EXPECT_EQ(bytes(one.radiance), bytes(many.radiance));
  EXPECT_EQ(bytes(one.variance), bytes(many.variance));
  EXPECT_EQ(bytes(one.albedo), bytes(many.albedo));
  EXPECT_EQ(one.sample_count, many.sample_count);
  EXPECT_EQ(one.part, many.part);
}

TEST(Adaptive, CountsItsSamples) {
  const NoiseScene scene = room_scene(40, 30);
  auto renderer = scene.builder.make();
  Film film;
  const RenderStats stats = renderer->render(scene.view, adaptive(scene, 0.12f, 50), &film);
  uint64_t counted = 0, at_most = 0;
  for (const uint32_t n : film.sample_count) {
    EXPECT_GE(n, 16u);
    EXPECT_LE(n, 50u);
    counted += n;
    at_most += n == 50 ? 1 : 0;
  }
  EXPECT_LE(counted, stats.paths);
  EXPECT_GT(counted, stats.paths * 6 / 10) << "too many samples are drawn and not used";
  EXPECT_GT(at_most, 0u);
  EXPECT_LE(stats.unreached, at_most);
  for (const Vec3f n : film.normal) EXPECT_LT(length(n), 1.001f);
}

TEST(Adaptive, NeverAsksMoreThanNeeded) {
  SceneBuilder b;  // the sky alone: no noise at all
  Image8 face{1, 1, 3, ColorSpace::kLinear, {255, 255, 255}};
  b.description.textures.push_back({"sky", std::vector<Image8>(6, face)});
  b.description.sky.texture = 0;
  for (const float scale : {0.0f, 7.0f}) {
    b.description.sky.scale = scale;
    const NoiseScene scene{"sky", b, SceneBuilder::camera(look_at({0, 0, 0}, {1, 0, 0}), 20, 20),
                           0};
    const Film film = b.render(scene.view, adaptive(scene, 1e-4f, 65536));
    for (size_t i = 0; i < film.radiance.size(); ++i) {
      EXPECT_EQ(film.sample_count[i], 16u);
      EXPECT_NEAR(film.radiance[i].y, scale, 1e-4f);
    }
  }
}

TEST(Adaptive, EndsWhenItsUserSaysSo) {
  const NoiseScene scene = room_scene(160, 120);
  auto renderer = scene.builder.make();
  for (const float error : {0.0f, 0.01f}) {  // even sampling listens as well
    RenderSettings settings = adaptive(scene, error, 4096);
    int calls = 0;
    settings.progress = [&](double done) {
      EXPECT_GE(done, 0);  // asked within the first tile, too
      EXPECT_LT(done, 1);
      return ++calls < 2;
    };
    Film film;
    const RenderStats stats = renderer->render(scene.view, settings, &film);
    EXPECT_FALSE(stats.finished);
    EXPECT_EQ(calls, 2);
    EXPECT_LT(stats.paths, 160u * 120 * 4096 / 2);
  }
}

}  // namespace
}  // namespace gloam

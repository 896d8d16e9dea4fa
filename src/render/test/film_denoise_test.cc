#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/test/source_dir.h"
#include "render/film/denoise.h"

namespace gloam {
namespace {

/// A floor under a checkerboard, a bright and a dark wall, sky above; every channel of it exact.
struct TestScene {
  Film film;                     // with noise
  std::vector<Vec3f> reference;  // without
};

TestScene make_scene(int width, int height, float noise, uint64_t seed) {
  TestScene scene;
  Film& f = scene.film;
  f.width = width;
  f.height = height;
  const RandomStream random{seed, stream_id("test.noise")};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
      const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
      Vec3f albedo, normal, light;
      float depth = INFINITY;
      if (v > 0.5f) {  // floor
        depth = 1 / (v - 0.45f);
        const bool dark = (static_cast<int>(u * 12) + static_cast<int>(depth * 2)) % 2 == 0;
        albedo = dark ? Vec3f{0.2f, 0.15f, 0.1f} : Vec3f{0.7f, 0.65f, 0.6f};
        normal = {0, 0, 1};
        light = Vec3f{1, 0.95f, 0.9f} * (300 * (0.4f + 0.6f * u));
      } else if (v > 0.1f) {  // two walls that meet in a corner
        const bool left = u < 0.5f;
        depth = left ? 10 + 10 * u : 20 - 10 * u;
        albedo = {0.8f, 0.8f, 0.8f};
        normal = left ? Vec3f{0.7071068f, -0.7071068f, 0} : Vec3f{-0.7071068f, -0.7071068f, 0};
        light = Vec3f{1, 1, 1} * (left ? 600.0f : 150.0f);
      }
      const bool sky = std::isinf(depth);
      const Vec3f truth = sky ? Vec3f{500, 700, 1000} : albedo * light;
      scene.reference.push_back(truth);
      // Noise of few samples: exponential, mean 1, mixed with the truth.
      const uint32_t i = static_cast<uint32_t>(y * width + x);
      const float e = -std::log(1 - static_cast<float>(random.uniform(0, i)) * 0.999999f);
      f.radiance.push_back(sky ? truth : truth * (1 + noise * (e - 1)));
      f.variance.push_back(sky ? Vec3f{} : truth * truth * (noise * noise));
      f.albedo.push_back(albedo);
      f.normal.push_back(normal);
      f.depth.push_back(depth);
    }
  }
  return scene;
}

double relative_error(const std::vector<Vec3f>& picture, const std::vector<Vec3f>& reference) {
  double sum = 0;
  for (size_t i = 0; i < picture.size(); ++i) {
    const Vec3f d = picture[i] - reference[i];
    sum += dot(d, d) / (dot(reference[i], reference[i]) + 1);
  }
  return std::sqrt(sum / static_cast<double>(picture.size()));
}

double mean_luminance(const std::vector<Vec3f>& picture) {
  double sum = 0;
  for (const Vec3f& c : picture) sum += luminance(c);
  return sum / static_cast<double>(picture.size());
}

/// Every denoiser must do all of this. Those of OIDN are skipped where the library is not
/// installed.
class DenoiseTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "own") {
      denoiser_ = make_edge_denoiser();
      return;
    }
    setenv("GLOAM_HOME", source_dir().c_str(), 1);
    Result<std::unique_ptr<Denoiser>> oidn = make_oidn_denoiser(
        {.quality = GetParam() == "oidn" ? DenoiseQuality::kBalanced : DenoiseQuality::kHigh});
    if (!oidn.ok()) GTEST_SKIP() << oidn.error().to_string();
    denoiser_ = std::move(oidn).value();
  }
  std::unique_ptr<Denoiser> denoiser_;
};

TEST_P(DenoiseTest, BringsThePictureMuchCloserToTheReference) {
  const TestScene scene = make_scene(320, 240, 0.5f, 7);
  std::vector<Vec3f> out;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
  const double before = relative_error(scene.film.radiance, scene.reference);
  const double after = relative_error(out, scene.reference);
  EXPECT_GT(before, 0.3);
  EXPECT_LT(after, before / 4);
}

TEST_P(DenoiseTest, KeepsTheMeanLight) {
  const TestScene scene = make_scene(320, 240, 0.5f, 8);
  std::vector<Vec3f> out;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
  EXPECT_NEAR(mean_luminance(out) / mean_luminance(scene.reference), 1, 0.03);
}

/// A wall lit from the right.
TestScene make_wall(int width, int height) {
  TestScene scene;
  Film& f = scene.film;
  f.width = width;
  f.height = height;
  f.albedo.assign(f.pixel_count(), {0.6f, 0.5f, 0.4f});
  f.normal.assign(f.pixel_count(), {0, 0, 1});
  f.depth.assign(f.pixel_count(), 3);
  for (int i = 0; i < width * height; ++i) {
    const float light = 50 + 100 * static_cast<float>(i % width) / static_cast<float>(width);
    scene.reference.push_back(f.albedo[static_cast<size_t>(i)] * light);
  }
  f.radiance = scene.reference;
  return scene;
}

// Light that comes by a rare path: four pixels of a hundred have two thirds of it.
TEST_P(DenoiseTest, KeepsTheLightOfRarePaths) {
  constexpr float kShare = 0.04f, kRare = 2.0f / 3;
  const RandomStream random{3, stream_id("test.rare")};
  double kept[3] = {}, found[3] = {};
  for (uint64_t picture = 0; picture < 8; ++picture) {
    TestScene scene = make_wall(96, 72);
    for (size_t i = 0; i < scene.film.radiance.size(); ++i) {
      const bool hit = random.uniform(picture, i) < static_cast<double>(kShare);
      const Vec3f whole = scene.reference[i], rare{1, 0.8f, 0.5f};  // a fire's
      scene.film.radiance[i] = whole * (1 - kRare);
      if (hit) scene.film.radiance[i] += whole * rare * (kRare / kShare);
    }
    std::vector<Vec3f> out;
    ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
    for (size_t i = 0; i < out.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        kept[c] += static_cast<double>(out[i][c]);
        found[c] += static_cast<double>(scene.film.radiance[i][c]);
      }
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(kept[c] / found[c], 1, 0.01) << "channel " << c;
}

TEST_P(DenoiseTest, LeavesNoMoreNoiseAtTheBorderThanInside) {
  const RandomStream random{6, stream_id("test.border")};
  double outermost = 0, inside = 0;
  for (uint64_t picture = 0; picture < 4; ++picture) {
    TestScene scene = make_wall(160, 120);
    for (size_t i = 0; i < scene.film.radiance.size(); ++i) {
      const float e = -std::log(1 - static_cast<float>(random.uniform(picture, i)) * 0.999999f);
      scene.film.radiance[i] *= 0.5f + 0.5f * e;
    }
    std::vector<Vec3f> out;
    ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
    const auto roughness = [&](int row) {  // mean of second differences along it
      double sum = 0;
      for (size_t x = 1; x + 1 < 160; ++x) {
        const size_t i = static_cast<size_t>(row) * 160 + x;
        const float bend = luminance(out[i - 1]) - 2 * luminance(out[i]) + luminance(out[i + 1]);
        sum += static_cast<double>(std::fabs(bend / luminance(scene.reference[i])));
      }
      return sum;
    };
    outermost += roughness(0) + roughness(119);
    inside += roughness(8) + roughness(111);
  }
  EXPECT_LT(outermost, 2.5 * inside);  // Open Image Denoise without a border: 5
}

TEST_P(DenoiseTest, KeepsEdgesOfShapeAndTexture) {
  const TestScene scene = make_scene(320, 240, 0.3f, 9);
  std::vector<Vec3f> out;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
  // Across the corner of the walls and across every edge of the checkerboard in one row of it.
  for (const int y : {80, 200}) {
    for (int x = 1; x < 320; ++x) {
      const size_t i = static_cast<size_t>(y * 320 + x);
      const float jump = luminance(scene.reference[i]) - luminance(scene.reference[i - 1]);
      if (std::fabs(jump) < 30) continue;
      const float kept = luminance(out[i]) - luminance(out[i - 1]);
      EXPECT_NEAR(kept / jump, 1, 0.35) << "at " << x << ", " << y;
    }
  }
}

/// A dark surface in front of a bright wall; the edge between them is slanted, so that each pixel
/// on it has a share of both, and the depth of one.
TestScene slanted_edge(float noise) {
  TestScene scene = make_scene(160, 120, 0, 1);
  Film& f = scene.film;
  const RandomStream random{5, stream_id("test.edge")};
  for (int y = 0; y < f.height; ++y) {
    for (int x = 0; x < f.width; ++x) {
      const size_t i = static_cast<size_t>(y * f.width + x);
      const float edge = 60 + 0.3f * static_cast<float>(y) - static_cast<float>(x);
      const float front = clamp(edge + 0.5f, 0, 1);
      f.albedo[i] = Vec3f{0.05f, 0.05f, 0.06f} * front + Vec3f{0.8f, 0.8f, 0.8f} * (1 - front);
      f.normal[i] = Vec3f{0, -1, 0} * front + Vec3f{0.6f, -0.8f, 0} * (1 - front);
      f.depth[i] = front > 0.5f ? 2.0f : 5.0f;
      scene.reference[i] = Vec3f{30, 30, 40} * front + Vec3f{200, 190, 180} * (1 - front);
      const float e = -std::log(1 - static_cast<float>(random.uniform(0, i)) * 0.999999f);
      f.radiance[i] = scene.reference[i] * (1 + noise * (e - 1));
    }
  }
  f.variance.clear();
  return scene;
}

TEST_P(DenoiseTest, DrawsNoSpecksAlongASlantedEdge) {
  const TestScene scene = slanted_edge(0.5f);
  std::vector<Vec3f> out;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
  double sum = 0;
  int pixels = 0;
  for (size_t i = 0; i < out.size(); ++i) {
    const float share = (luminance(scene.reference[i]) - 30.7f) / (191.4f - 30.7f);
    if (share < 0.05f || share > 0.95f) continue;
    sum += std::pow(luminance(out[i]) / luminance(scene.reference[i]) - 1, 2);
    ++pixels;
  }
  EXPECT_GT(pixels, 100);
  EXPECT_LT(std::sqrt(sum / pixels), 0.42);  // the filter without mend_edges(): 0.48
}

TEST_P(DenoiseTest, LeavesACleanPictureAlone) {
  TestScene scene = make_scene(160, 120, 0, 1);
  std::vector<Vec3f> out;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
  EXPECT_LT(relative_error(out, scene.reference), 0.03);
}

TEST_P(DenoiseTest, SurvivesFirefliesAndNotANumber) {
  TestScene scene = make_scene(160, 120, 0.3f, 3);
  for (const size_t i : {size_t{40 * 160 + 40}, size_t{100 * 160 + 100}})
    scene.film.radiance[i] = {1e5f, 1e5f, 1e5f};
  scene.film.radiance[80 * 160 + 10] = {NAN, INFINITY, -1};
  std::vector<Vec3f> out;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
  for (size_t i = 0; i < out.size(); ++i) {
    ASSERT_TRUE(std::isfinite(luminance(out[i])));
    EXPECT_LT(luminance(out[i]), 2.5f * max(luminance(scene.reference[i]), 100)) << i;
  }
}

TEST_P(DenoiseTest, TakesFilmsWithoutGuidesAndOfAnySize) {
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 2}, {17, 5}, {64, 64}, {33, 70}}) {
    TestScene scene = make_scene(w, h, 0.5f, 4);
    std::vector<Vec3f> out;
    ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
    EXPECT_EQ(out.size(), scene.reference.size());
    scene.film.albedo.clear();
    scene.film.normal.clear();
    scene.film.depth.clear();
    scene.film.variance.clear();
    ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
    for (const Vec3f& c : out) ASSERT_TRUE(std::isfinite(luminance(c)));
  }
}

TEST_P(DenoiseTest, IsEqualForAnyNumberOfThreadsAndFromRunToRun) {
  const TestScene scene = make_scene(160, 120, 0.5f, 11);
  std::vector<Vec3f> reference;
  ASSERT_TRUE(denoiser_->denoise(scene.film, &reference).ok());
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    SetUp();  // OIDN takes its number of threads when it is made
    std::vector<Vec3f> out;
    for (int run = 0; run < 2; ++run) {
      ASSERT_TRUE(denoiser_->denoise(scene.film, &out).ok());
      ASSERT_TRUE(out == reference) << threads << " threads, run " << run;
    }
  }
  set_thread_count(0);
}

INSTANTIATE_TEST_SUITE_P(All, DenoiseTest, testing::Values("own", "oidn", "oidn_high"),
                         [](const auto& info) { return info.param; });

TEST(Denoise, FallsBackToOurOwnFilterWhereOidnIsMissing) {
  setenv("GLOAM_OIDN", "/nowhere", 1);
  const Result<std::unique_ptr<Denoiser>> missing =
      make_oidn_denoiser({.quality = DenoiseQuality::kFast});
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().to_string().find("not installed"), std::string::npos);
  EXPECT_STREQ(make_denoiser({})->name(), "Gloam edge filter");
  unsetenv("GLOAM_OIDN");
  EXPECT_STREQ(make_denoiser({.use_oidn = false})->name(), "Gloam edge filter");
}

TEST(Denoise, FireflyFilterKeepsHighlightsOfThreePixels) {
  Film film;
  film.width = film.height = 16;
  film.radiance.assign(256, Vec3f{1, 1, 1});
  film.radiance[8 * 16 + 3] = {500, 500, 500};
  for (const size_t i :
       {size_t{4 * 16 + 9}, size_t{5 * 16 + 9}, size_t{6 * 16 + 9}, size_t{7 * 16 + 9}})
    film.radiance[i] = {50, 60, 70};
  std::vector<Vec3f> out, light;
  remove_fireflies(film, &out, &light);
  EXPECT_NEAR(out[8 * 16 + 3].x, 4, 0.3);
  EXPECT_NEAR(out[5 * 16 + 9].z, 70, 0.3);
  EXPECT_NEAR(out[0].x, 1, 0.3);
}

TEST(Denoise, SpreadsTheLightOfFirefliesOverSurfacesThatFaceTheirWay) {
  // A grey wall above, a brown one below it that faces elsewhere, and a dark stripe on the grey.
  const int n = 64;
  const Vec3f grey{0.5f, 0.5f, 0.5f}, brown{0.6f, 0.3f, 0.1f}, dark{0.05f, 0.05f, 0.05f};
  Film film;
  film.width = film.height = n;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const bool above = y < n / 2;
      film.albedo.push_back(!above ? brown : x < 4 ? dark : grey);
      film.normal.push_back(above ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0});
      film.radiance.push_back(film.albedo.back() * 10.0f);
    }
  }
  const size_t fly = static_cast<size_t>(20 * n + 16);
  film.radiance[fly] = {105, 105, 105};  // 85 more than its limit
  std::vector<Vec3f> out, light;
  remove_fireflies(film, &out, &light);
  EXPECT_NEAR(mean_luminance(out) / mean_luminance(film.radiance), 1, 1e-4);
  EXPECT_EQ(light[fly].x, 105);
  EXPECT_NEAR(out[fly].x, 20, 1);
  EXPECT_GT(out[fly + 5].x, 5.05f) << "the wall around gets the light";
  const size_t stripe = static_cast<size_t>(20 * n + 2);
  EXPECT_NEAR((out[stripe].x - 0.5f) / (out[fly + 5].x - 5), 0.1, 0.01) << "as its albedo has it";
  const size_t below = static_cast<size_t>(33 * n + 16), far = static_cast<size_t>(20 * n + 60);
  EXPECT_EQ(out[below].x, film.radiance[below].x);
  EXPECT_EQ(out[far].x, film.radiance[far].x);
}

TEST(Denoise, RestoresLightWhereItWas) {
  // Left half: half of the red is gone. Right half: all is there.
  const int w = 400, h = 40;
  std::vector<Vec3f> light(static_cast<size_t>(w * h), Vec3f{10, 10, 10}), picture = light;
  for (size_t i = 0; i < picture.size(); ++i)
    if (i % w < w / 2) picture[i].x = 5;
  restore_light(light, w, h, &picture);
  EXPECT_NEAR(mean_luminance(picture) / mean_luminance(light), 1, 1e-5);
  EXPECT_NEAR(picture[20 * w + 20].x, 10, 0.2);
  EXPECT_NEAR(picture[20 * w + 380].x, 10, 0.2);
  EXPECT_NEAR(picture[20 * w + 20].y, 10, 1e-4);
  std::vector<Vec3f> black(light.size());
  restore_light(light, w, h, &black);
  EXPECT_EQ(mean_luminance(black), 0) << "what is black stays black";
}

}  // namespace
}  // namespace gloam

// The interactive tier's history on a card, run on the host: what joins, what is refused, and how
// fast changed light is followed.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "render/kernel/interactive/temporal_light.h"
#include "render/kernel/interactive/temporal_restore.h"

namespace gloam {
namespace {

constexpr int kWidth = 24, kHeight = 16;
constexpr size_t kPixels = size_t{kWidth} * kHeight;

struct Planes {
  std::vector<Vec3f> light{kPixels}, recent{kPixels}, noisy{kPixels}, normal{kPixels};
  std::vector<float> age = std::vector<float>(kPixels), distance = age, square = age;
  std::vector<uint32_t> part = std::vector<uint32_t>(kPixels);
  TemporalPlanes view() {
    return {light.data(), recent.data(),   noisy.data(), square.data(),
            age.data(),   distance.data(), part.data(),  normal.data()};
  }
};

/// A camera that looks down on a floor, 2 m below.
struct Floor {
  Planes planes[2];
  std::vector<Vec3f> radiance{kPixels}, albedo{kPixels}, scene_flow{kPixels}, color{kPixels},
      shown{kPixels};
  std::vector<Vec3f> denoised;  ///< empty = radiance
  std::vector<BlockLight> blocks;
  std::vector<float> clear;  ///< empty = no media
  std::vector<uint32_t> part = std::vector<uint32_t>(kPixels, 1);
  std::vector<Vec2f> motion{kPixels};
  TemporalPicture picture;
  int taken = 0;
  RandomStream random{3, 0};

  Floor() {
    picture.width = kWidth;
    picture.height = kHeight;
    picture.camera.fx = picture.camera.fy = 20;
    picture.camera.cx = 0.5f * kWidth;
    picture.camera.cy = 0.5f * kHeight;
    picture.camera.pose.X_WC_open.p = picture.camera.pose.X_WC_previous.p = {0, 0, 2};
    for (Vec3f& a : albedo) a = {0.5f, 0.25f, 0.8f};
  }

  /// Light with so much noise that single pictures are of no use: nothing, or in a `share` of the
  /// pixels so much that the mean is right.
  void take(Vec3f mean, float share = 0.25f) {
    for (size_t i = 0; i < kPixels; ++i) {
      const double u = random.uniform(static_cast<uint64_t>(taken), static_cast<uint32_t>(i));
      radiance[i] = mean * (u < share ? 1 / share : 0.0f);
    }
    join();
  }

  void join() {
    Planes& now = planes[taken % 2];
    each([&](int x, int y) {
      const size_t i = picture.index(x, y);
      RayCone cone;
      const Ray ray = camera_ray(picture.camera, static_cast<float>(x) + 0.5f,
                                 static_cast<float>(y) + 0.5f, 0, &cone);
      now.normal[i] = {0, 0, 1};
      now.distance[i] = -ray.o.z / ray.d.z;
    });
    picture.noisy = radiance.data();
    picture.radiance = denoised.empty() ? radiance.data() : denoised.data();
    picture.clear = clear.empty() ? nullptr : clear.data();
    picture.part = part.data();
    blocks.resize(size_t(picture.block_columns()) * size_t(picture.block_rows()));
    picture.blocks = blocks.data();
    picture.albedo = albedo.data();
    picture.motion = motion.data();
    picture.scene_flow = scene_flow.data();
    picture.now = now.view();
    picture.before = planes[(taken + 1) % 2].view();
    picture.has_before = taken > 0;
    picture.color = color.data();
    picture.shown = shown.data();
    each([&](int x, int y) { temporal::accumulate(picture, x, y); });
    each([&](int x, int y) { temporal::settle(picture, x, y); });
    each([&](int x, int y) { temporal::compose(picture, x, y); });
    ++taken;
  }

  void restore() {
    each([&](int x, int y) { temporal::add_details(picture, x, y); });
    for (int row = 0; row < picture.block_rows(); ++row)
      for (int column = 0; column < picture.block_columns(); ++column)
        temporal::sum_block(picture, column, row);
    each([&](int x, int y) { temporal::restore(picture, x, y); });
  }

  template <class F>
  static void each(const F& f) {
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) f(x, y);
  }
  static Vec3f mean(const std::vector<Vec3f>& light) {
    Vec3f sum;
    for (const Vec3f& c : light) sum += c;
    return sum / static_cast<float>(kPixels);
  }
  Planes& last() { return planes[(taken + 1) % 2]; }
};

TEST(Temporal, LightThatRestsConvergesToItsMean) {
  Floor floor;
  for (int i = 0; i < 120; ++i) floor.take({10, 20, 5});
  const Vec3f mean = Floor::mean(floor.color);
  EXPECT_NEAR(mean.x, 10, 0.2);
  EXPECT_NEAR(mean.y, 20, 0.4);
  EXPECT_NEAR(mean.z, 5, 0.1);
  double worst = 0;
  for (const Vec3f& c : floor.color) worst = std::max(worst, std::fabs(double{c.y} / 20 - 1));
  EXPECT_LT(worst, 0.9);  // a single picture: 3
  EXPECT_EQ(floor.last().age[0], temporal::kMostAge);
}

TEST(Temporal, LightOfRareSamplesIsKept) {
  Floor floor;
  for (int i = 0; i < 200; ++i) floor.take({10, 20, 5}, 0.02f);
  EXPECT_LT(Floor::mean(floor.color).y, 19) << "the clamp alone loses light: is the test too easy?";
  floor.restore();  // to the noisy mean of the last pictures; 1 standard error is 2 %
  const Vec3f mean = Floor::mean(floor.shown);
  EXPECT_NEAR(mean.y, 20, 1.6);
  EXPECT_NEAR(mean.x, 0.5 * double{mean.y}, 1e-3);
}

TEST(Temporal, DetailsThatADenoiserBlursAreShownIfTheyAreCertain) {
  Floor floor;
  const size_t spot = floor.picture.index(12, 8);
  floor.denoised.assign(kPixels, {10, 10, 10});
  floor.radiance.assign(kPixels, {10, 10, 10});
  for (const size_t row : {0u, 1u, 2u})
    for (const size_t column : {0u, 1u, 2u})
      floor.radiance[spot + row * kWidth + column - kWidth - 1] = {100, 100, 100};
  for (int i = 0; i < 45; ++i) floor.join();
  floor.restore();
  EXPECT_GT(floor.shown[spot].x, 80) << "light without noise is certain";
  EXPECT_NEAR(floor.shown[spot + 6].x, 10, 1);
  Floor noise;
  noise.denoised.assign(kPixels, {10, 10, 10});
  for (int i = 0; i < 60; ++i) noise.take({10, 10, 10}, 0.1f);
  noise.restore();
  for (const Vec3f& shown : noise.shown) EXPECT_NEAR(shown.x, 10, 2.5) << "noise is no detail";
}

TEST(Temporal, TheNoiseOfAFirstPictureIsNoDetail) {
  Floor floor;
  floor.denoised.assign(kPixels, {10, 10, 10});
  for (int i = 0; i < 12; ++i) {
    floor.picture.weight = i == 0 ? 16.0f : 1.0f;  // a cut's picture has more samples
    floor.take({10, 10, 10}, 0.4f);
    floor.restore();
    for (const Vec3f& shown : floor.shown) ASSERT_NEAR(shown.x, 10, 2.5) << "picture " << i;
  }
}

TEST(Temporal, ALampDoesNotChangeTheWallBesideIt) {
  Floor floor;
  for (size_t i = 0; i < kPixels; ++i) {
    const bool is_lamp = i % kWidth >= 16;
    floor.part[i] = is_lamp ? 2 : 1;
    floor.radiance[i] = is_lamp ? Vec3f{1e4f, 1e4f, 1e4f} : Vec3f{10, 10, 10};
  }
  floor.join();
  for (size_t i = 0; i < kPixels; ++i)
    if (floor.part[i] == 2) floor.color[i] *= 1.2f;  // the lamp's shown light is wrong
  floor.restore();
  EXPECT_NEAR(floor.shown[floor.picture.index(4, 8)].x, 10, 1);
}

TEST(Temporal, BordersKeepTheLightThatDenoisersLoseThere) {
  Floor floor;
  floor.denoised.assign(kPixels, {9, 9, 9});
  for (size_t i = 0; i < kPixels; ++i) {
    const size_t x = i % kWidth;
    floor.part[i] = x < 12 ? 1 : 2;
    if (x == 11 || x == 12) floor.denoised[i] = {4, 4, 4};
  }
  for (int i = 0; i < 40; ++i) floor.take({10, 10, 10}, 0.5f);
  floor.restore();
  for (const int x : {3, 11, 12, 20})
    EXPECT_NEAR(floor.shown[floor.picture.index(x, 8)].x, 10, 1.5) << x;
}

TEST(Temporal, BordersThatMoveTakeTheLightOfTheirObject) {
  Floor floor;
  // The border between a dark and a bright object moves by a pixel each time, so that its pixels
  // have no history; their light is noise.
  for (int k = 0; k < 12; ++k) {
    const auto border = static_cast<size_t>(5 + k);
    for (size_t i = 0; i < kPixels; ++i) {
      const bool dark = i % kWidth < border;
      floor.part[i] = dark ? 1 : 2;
      floor.albedo[i] = dark ? Vec3f{0.1f, 0.1f, 0.1f} : Vec3f{0.8f, 0.8f, 0.8f};
    }
    for (size_t i = 0; i < kPixels; ++i) {
      const double u = floor.random.uniform(static_cast<uint64_t>(k), static_cast<uint32_t>(i));
      floor.radiance[i] = floor.albedo[i] * (u < 0.5 ? 200.0f : 0.0f);
    }
    floor.join();
  }
  floor.restore();
  double squares = 0;
  for (int y = 0; y < kHeight; ++y) {
    const float dark = floor.color[floor.picture.index(15, y)].x / 10 - 1;
    const float bright = floor.color[floor.picture.index(16, y)].x / 80 - 1;
    squares += dark * dark + bright * bright;
  }
  EXPECT_LT(std::sqrt(squares / (2 * kHeight)), 0.4);  // single pixels: 1
}

TEST(Temporal, PixelsOfTwoObjectsKeepTheirLight) {
  Floor floor;
  // A dark object before a bright one: the pixels at its border show both.
  for (size_t i = 0; i < kPixels; ++i) {
    const size_t x = i % kWidth;
    floor.part[i] = x < 12 ? 1 : 2;
    floor.albedo[i] = x < 12 ? Vec3f{0.05f, 0.05f, 0.05f} : Vec3f{0.8f, 0.8f, 0.8f};
    const float light = x < 11 ? 5.0f : (x == 11 ? 500.0f : 1000.0f);
    floor.radiance[i] = {light, light, light};
  }
  for (int i = 0; i < 10; ++i) floor.join();
  EXPECT_NEAR(floor.color[floor.picture.index(11, 8)].x, 500, 5);
  EXPECT_NEAR(floor.color[floor.picture.index(8, 8)].x, 5, 0.1);
  EXPECT_NEAR(floor.color[floor.picture.index(15, 8)].x, 1000, 10);
}

TEST(Temporal, DarkPartsOfASurfaceTakeNoLightFromBrightOnes) {
  Floor floor;
  // A texture with dark spots passes before the camera: the light on it is even.
  for (int k = 0; k < 12; ++k) {
    for (size_t i = 0; i < kPixels; ++i) {
      const float color = (i % kWidth + static_cast<size_t>(k)) % 4 == 0 ? 0.04f : 0.1f;
      floor.albedo[i] = {color, color, color};
      floor.radiance[i] = floor.albedo[i] * 100;
    }
    floor.join();
  }
  floor.restore();
  for (const Vec3f& shown : floor.shown) EXPECT_LT(shown.x, 15) << "not 100 of white surfaces";
}

TEST(Temporal, MediaDoNotDependOnTheSurfacesBehind) {
  Floor floor;
  floor.clear.assign(kPixels, 0.1f);
  for (int i = 0; i < 4; ++i) floor.take({10, 10, 10});
  for (size_t i = 0; i < kPixels; ++i) floor.part[i] = 2 + i % 3;
  floor.take({10, 10, 10});
  EXPECT_EQ(floor.last().age[7], 5);
  floor.clear.assign(kPixels, 0.9f);
  floor.take({10, 10, 10});
  EXPECT_EQ(floor.last().age[7], 1);
}

TEST(Temporal, HistoryGoesWithTheMotion) {
  Floor floor;
  floor.take({10, 10, 10});
  const std::vector<Vec3f> before = floor.last().recent;
  // The camera shifts by two pixels of the floor to the left: what it sees goes to the right.
  floor.picture.camera.pose.X_WC_open.p.x -= 0.2f;
  for (Vec2f& m : floor.motion) m = {2, 0};
  floor.take({0, 0, 0});
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const size_t i = floor.picture.index(x, y);
      ASSERT_EQ(floor.last().age[i], x < 2 ? 1.0f : 2.0f) << x << " " << y;
      if (x >= 2) {
        ASSERT_NEAR(floor.last().recent[i].x, 0.5f * before[i - 2].x, 1e-3f);
      }
    }
  }
}

TEST(Temporal, OtherSurfacesAreRefused) {
  for (const int how : {0, 1, 2}) {
    Floor floor;
    for (int i = 0; i < 4; ++i) floor.take({10, 10, 10});
    Planes& old = floor.last();
    const size_t i = floor.picture.index(5, 5);
    if (how == 0) old.part[i] = 2;
    if (how == 1) old.normal[i] = {1, 0, 0};
    if (how == 2) old.distance[i] = 1.5f;
    floor.take({10, 10, 10});
    EXPECT_EQ(floor.last().age[i], 1) << how;
    EXPECT_EQ(floor.last().age[i + 1], 5) << how;
  }
}

TEST(Temporal, ChangedLightIsFollowedSoonerThanByTheMeanAlone) {
  Floor floor;
  for (int i = 0; i < 100; ++i) floor.take({10, 10, 10});
  for (int i = 0; i < 16; ++i) floor.take({1, 1, 1});
  const double mean_alone = 1 + 9 * std::pow(1 - 1 / double{temporal::kMostAge}, 16);  // 7.4
  EXPECT_LT(Floor::mean(floor.color).x, 0.5 * mean_alone);
}

TEST(Temporal, WhatIsNoLightIsBlack) {
  Floor floor;
  for (const float bad : {NAN, INFINITY, -1.0f}) {
    floor.take({10, 10, 10});
    floor.radiance[7] = {bad, 1, 1};
    floor.join();
    EXPECT_TRUE(std::isfinite(floor.color[7].x)) << bad;
    EXPECT_GE(floor.color[7].x, 0) << bad;
  }
}

}  // namespace
}  // namespace gloam

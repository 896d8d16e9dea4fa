// LiDAR beams of some width, and noise: statistics against the models' parameters.

#include <cmath>

#include "base/parallel.h"
#include "sensors/test/lidar_scene.h"

namespace gloam {
namespace {

TEST(LidarFootprint, AnEdgeSplitsABeamInTwo) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 10, 10}, {5.5f, 10, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));  // y > 0
  add_wall(&b, {0.5f, 50, 50}, {9.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LidarOptions options = pencil();
  options.divergence = {{0.5, 0.5}};
  options.footprint_rays = 32;
  const auto split = scan_scene(b, options);
  ASSERT_EQ(split->size(), 2u);
  EXPECT_NEAR(split->range[0], 5, 1e-3);
  EXPECT_NEAR(split->range[1], 9, 1e-3);
  EXPECT_NEAR(split->intensity[0], 25, 2);  // half of the beam each
  EXPECT_NEAR(split->intensity[0] + split->intensity[1], 50, 0.01);

  options.footprint_rays = 1;
  EXPECT_EQ(scan_scene(b, options)->size(), 1u) << "one ray is an infinitely thin beam";
}

TEST(LidarFootprint, WhatTheReceiverCannotTellApartIsOnePointBetween) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 10, 10}, {5.5f, 10, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  add_wall(&b, {0.5f, 50, 50}, {5.7f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LidarOptions options = pencil();
  options.divergence = {{0.5, 0.5}};
  options.footprint_rays = 32;
  options.pulse_length = 0.5;
  const auto mixed = scan_scene(b, options);
  ASSERT_EQ(mixed->size(), 1u);
  EXPECT_GT(mixed->range[0], 5.05f);
  EXPECT_LT(mixed->range[0], 5.15f);
}

// A range finder with a cone of 27 degrees, as docs/lidar.md makes one.
TEST(LidarFootprint, AConeFindsWhatStandsBesideItsAxis) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {3.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  add_wall(&b, {0.05f, 0.05f, 50}, {2.05f, 0.3f, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));  // a post
  LidarOptions options = pencil();
  options.divergence = {{27, 27}};
  options.footprint_rays = 32;
  options.returns = "first";
  const auto first = scan_scene(b, options);
  ASSERT_EQ(first->size(), 1u);
  EXPECT_NEAR(first->range[0], 2.02, 0.05) << "8.5 degrees off the axis";
  options.returns = "strongest";
  EXPECT_NEAR(scan_scene(b, options)->range[0], 3.03, 0.05) << "the wall is larger";
  options.pulse_length = 10;
  const float mean = scan_scene(b, options)->range[0];
  EXPECT_GT(mean, 2.2f) << "of both, by their signals";
  EXPECT_LT(mean, 2.97f);
  options.footprint_rays = 1;
  EXPECT_NEAR(scan_scene(b, options)->range[0], 3, 1e-4) << "a thin ray misses the post";
}

TEST(LidarNoise, RecoversItsStandardDeviationsFromSamples) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {20.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LidarOptions options = pencil(320, 320);
  options.noise = true;
  options.range_noise = 0.02;
  options.range_at_10_percent = 40;
  options.intensity = "signal";
  const auto scan = scan_scene(b, options);
  ASSERT_EQ(scan->size(), 102400u);
  const double signal = 0.5 / 400, noise = 0.1 / 1600 / 12;
  const double wanted = std::sqrt(0.02 * 0.02 + 0.3 * 0.3 * noise / signal);
  expect_moments(scan->range, 20, wanted * wanted, "range");
  expect_moments(scan->intensity, signal, noise * noise, "amplitude");
  const auto n = static_cast<double>(scan->size());
  double product = 0;
  for (size_t i = 0; i + 1 < scan->size(); ++i)
    product += (scan->range[i] - 20.0) * (scan->range[i + 1] - 20.0);
  EXPECT_LT(std::abs(product) / n, 3 * wanted * wanted / std::sqrt(n)) << "neighbours correlate";
}

TEST(LidarNoise, AtTheThresholdHalfOfTheReturnsDrop) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {40.5f, 0, 0}, b.add_diffuse({0.1f, 0.1f, 0.1f}));
  LidarOptions options = pencil(320, 320);
  options.noise = true;
  options.range_at_10_percent = 40;
  const double seen = static_cast<double>(scan_scene(b, options)->size()) / 102400;
  EXPECT_NEAR(seen, 0.5, 3 * 0.5 / std::sqrt(102400.0));
}

TEST(LidarNoise, IsAFunctionOfTheSeedAndTheScanAndNothingElse) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 50, 50}, {20.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  b.add(ShapeType::kSphere, {1, 0, 0}, translation({6, 1, 0}), 0);
  MediumDescription fog;
  fog.name = "fog";
  fog.mass_extinction.fill(1);
  fog.albedo.fill(0.9f);
  b.description.media.push_back(fog);
  VolumeDescription volume;
  volume.name = "fog";
  volume.size = {100, 100, 100};
  volume.even_density = 0.03f;
  b.description.volumes.push_back(volume);
  LidarOptions options = ideal_lidar("HDL-32E");
  options.noise = true;
  options.range_at_10_percent = 60;
  options.footprint_rays = 5;
  options.returns = "all";
  options.columns = 200;
  set_thread_count(1);
  const auto one = scan_scene(b, options);
  set_thread_count(3);
  const auto three = scan_scene(b, options);
  const auto other_seed = scan_scene(b, options, 0, {}, 0, 2);
  const auto other_scan = scan_scene(b, options, 0, {}, 1, 1);
  set_thread_count(0);
  ASSERT_GT(one->size(), 1000u);
  EXPECT_EQ(one->range, three->range);
  EXPECT_EQ(one->intensity, three->intensity);
  EXPECT_EQ(one->part, three->part);
  EXPECT_NE(one->range, other_seed->range);
  EXPECT_NE(one->range, other_scan->range);
}

}  // namespace
}  // namespace gloam

// What LiDARs report: intensity, drop-outs, several returns, footprints, noise.

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sensors/test/lidar_scene.h"

namespace gloam {
namespace {

/// `rows` x `columns` beams straight ahead, all but parallel.
LidarOptions pencil(int rows = 1, int columns = 1) {
  LidarOptions options = ideal_lidar();
  options.pattern = "raster";
  options.rows = rows;
  options.columns = columns;
  options.field_of_view = {{0.01, 0.01}};
  options.returns = "all";
  return options;
}

MaterialDescription pane_material(bool thin) {
  MaterialDescription m;
  m.base_color = {0, 0, 0};
  m.transmission_weight = 1;
  m.roughness = 0;
  m.thin_walled = thin;
  return m;
}

/// Mean and standard deviation.
struct Moments {
  double mean = 0, deviation = 0;
  size_t n = 0;
};
Moments moments(const std::vector<float>& values) {
  Moments m;
  m.n = values.size();
  for (const float v : values) m.mean += v;
  m.mean /= static_cast<double>(m.n);
  for (const float v : values) m.deviation += (v - m.mean) * (v - m.mean);
  m.deviation = std::sqrt(m.deviation / static_cast<double>(m.n - 1));
  return m;
}

TEST(LidarIntensity, IsTheReflectanceTimesTheCosineOfIncidenceAtAnyRange) {
  SceneBuilder b;
  add_wall(&b, {0.5f, 300, 300}, {10.5f, 0, 0}, b.add_diffuse({0.4f, 0.9f, 0.9f}));
  LidarOptions options = ideal_lidar();
  options.azimuth = {{-70, 70}};
  const auto scan = scan_scene(b, options);
  ASSERT_GT(scan->size(), 10000u);
  for (size_t i = 0; i < scan->size(); ++i) {
    const double cosine = 10 / static_cast<double>(scan->range[i]);
    EXPECT_NEAR(scan->intensity[i], 100 * 0.4 * cosine, 0.01);
  }
}

TEST(LidarIntensity, ARoughMetalSendsBackByItsLobe) {
  SceneBuilder b;
  MaterialDescription metal;
  metal.base_color = {0.05f, 0.05f, 0.05f};  // so dark that light is hardly scattered twice
  metal.metallic = 1;
  metal.roughness = 0.5f;
  add_wall(&b, {0.5f, 300, 300}, {10.5f, 0, 0}, b.add_material(metal));
  LidarOptions options = ideal_lidar();
  options.azimuth = {{-60, 60}};
  options.elevations = {{0}};
  options.intensity = "signal";
  const auto scan = scan_scene(b, options);
  for (size_t i = 0; i < scan->size(); ++i) {
    const double c = 10 / static_cast<double>(scan->range[i]);
    // GGX back along the view: D G2 / (4 cos²), with h = w: F = F0.
    const double a2 = 0.0625, t2 = (1 - c * c) / (c * c), k = c * c * (a2 + t2);
    const double d = a2 / (M_PI * k * k), lambda = 0.5 * (std::sqrt(1 + a2 * t2) - 1);
    const double lobe = 0.05 * d / (1 + 2 * lambda) / (4 * c * c);
    const double g = scan->intensity[i] * scan->range[i] * scan->range[i];
    ASSERT_NEAR(g / (M_PI * lobe * c), 1, 0.02) << c;
  }
}

TEST(LidarIntensity, AMirrorSendsBackAlmostOnlyAcrossTheBeam) {
  SceneBuilder b;
  MaterialDescription mirror;
  mirror.base_color = {0.9f, 0.9f, 0.9f};
  mirror.metallic = 1;
  mirror.roughness = 0;
  add_wall(&b, {0.5f, 300, 300}, {10.5f, 0, 0}, b.add_material(mirror));
  LidarOptions options = ideal_lidar();
  options.azimuth = {{-60, 60}};
  options.elevations = {{0}};
  options.intensity = "signal";
  const auto scan = scan_scene(b, options);
  double ahead = 0, aside = 0;
  for (size_t i = 0; i < scan->size(); ++i) {
    const double g = scan->intensity[i] * scan->range[i] * scan->range[i];
    if (std::abs(scan->y[i]) < 1e-3f) ahead = g;
    if (std::abs(scan->y[i]) > 1) aside = std::max(aside, g);
  }
  // A mirror throws a beam of the full angle w at 1/e² into a spot 1 / w² as bright as a plate's.
  const double width = 0.13 * 1.6986 * M_PI / 180;
  EXPECT_NEAR(ahead * width * width / 0.9, 1, 0.02);
  EXPECT_LT(aside, 0.1);
}

TEST(LidarIntensity, ASurfaceMayBeAnotherAtTheSensorsWavelength) {
  SceneBuilder b;
  MaterialDescription leaf;
  leaf.name = "plant/leaf";
  leaf.base_color = {0.05f, 0.3f, 0.04f};
  leaf.specular_weight = 0;
  MaterialDescription tape = leaf;
  tape.name = "tape";
  add_wall(&b, {0.5f, 2, 2}, {5.5f, 2, 0}, b.add_material(leaf));
  add_wall(&b, {0.5f, 2, 2}, {5.5f, -2, 0}, b.add_material(tape));
  LidarOptions options = pencil(1, 2);
  options.field_of_view = {{20, 1}};
  options.intensity = "signal";
  options.surfaces = {{.material = "plant/*", .diffuse = 0.5}, {.material = "tape", .retro = 70}};
  const auto scan = scan_scene(b, options);
  ASSERT_EQ(scan->size(), 2u);
  const double cosine = std::cos(5 * M_PI / 180), r2 = 25 / cosine / cosine;
  EXPECT_NEAR(scan->intensity[0] * r2, 0.5 * cosine, 1e-3);
  EXPECT_NEAR(scan->intensity[1] * r2, (0.05 + 70 * M_PI) * cosine, 0.1);

  options.surfaces[1].material = "tap";
  const LidarDescription lidar{options, 0, {}};
  const auto refused = LidarSensor::create(b.description, lidar, 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().to_string().find("tape"), std::string::npos);
}

TEST(LidarIntensity, WaterDarkensWalls) {
  double intensity[2];
  for (int wet = 0; wet < 2; ++wet) {
    SceneBuilder b;
    MaterialDescription m;
    m.base_color = {0.4f, 0.4f, 0.4f};
    m.roughness = 0.8f;
    m.wetness = wet != 0 ? 0.8f : 0.0f;
    b.add(ShapeType::kBox, {0.5f, 300, 300}, rigid({0, 0, 1}, 0.6f, {12, 0, 0}), b.add_material(m));
    intensity[wet] = moments(scan_scene(b, pencil(16, 16))->intensity).mean;
  }
  EXPECT_LT(intensity[1], 0.8 * intensity[0]);
  EXPECT_GT(intensity[1], 0.1 * intensity[0]);
}

TEST(LidarDetection, APlateOfTenPercentIsSeenUpToTheSheetsRangeAndBlackDrops) {
  const auto seen = [](float reflectance, float range) {
    SceneBuilder b;
    add_wall(&b, {0.5f, 50, 50}, {range + 0.5f, 0, 0},
             b.add_diffuse({reflectance, reflectance, reflectance}));
    LidarOptions options = pencil();
    options.range_at_10_percent = 40;
    return scan_scene(b, options)->size() == 1;
  };
  EXPECT_TRUE(seen(0.1f, 39.9f));
  EXPECT_FALSE(seen(0.1f, 40.1f));
  EXPECT_TRUE(seen(0.4f, 79.8f));  // twice as far
  EXPECT_FALSE(seen(0.4f, 80.2f));
  EXPECT_FALSE(seen(0.02f, 20));  // black
}

TEST(LidarReturnsOf, APaneAcrossTheBeamGivesTwo) {
  SceneBuilder b;
  add_wall(&b, {0.005f, 2, 2}, {3, 0, 0}, b.add_material(pane_material(true)));
  add_wall(&b, {0.5f, 50, 50}, {6.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  // The box's two faces are two sheets, closer together than the receiver resolves.
  const auto scan = scan_scene(b, pencil());
  ASSERT_EQ(scan->size(), 2u);
  EXPECT_NEAR(scan->range[0], 3, 0.01);
  EXPECT_NEAR(scan->range[1], 6, 1e-3);
  EXPECT_EQ(scan->part[0], 1u);
  EXPECT_EQ(scan->part[1], 2u);
  EXPECT_EQ(scan->return_number[1], 1);
  EXPECT_GT(scan->intensity[0], 100) << "a mirror across the beam outshines a white plate";
  const double sheet = (1 - 0.04) / (1 + 0.04);  // lets through, its inner reflections included
  EXPECT_NEAR(scan->intensity[1], 50 * std::pow(sheet, 4), 0.1);
}

TEST(LidarReturnsOf, ASlantedPaneIsNotSeenItself) {
  SceneBuilder b;
  b.add(ShapeType::kBox, {0.005f, 2, 2}, rigid({0, 0, 1}, 0.6f, {3, 0, 0}),
        b.add_material(pane_material(true)));
  add_wall(&b, {0.5f, 50, 50}, {6.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  LidarOptions options = pencil();
  options.range_at_10_percent = 40;
  const auto scan = scan_scene(b, options);
  ASSERT_EQ(scan->size(), 1u);
  EXPECT_EQ(scan->part[0], 2u);
}

TEST(LidarReturnsOf, AGlassBlockMakesTheWayLonger) {
  SceneBuilder b;
  add_wall(&b, {0.2f, 2, 2}, {3, 0, 0}, b.add_material(pane_material(false)));
  add_wall(&b, {0.5f, 50, 50}, {6.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  const auto scan = scan_scene(b, pencil());
  const auto last = scan->size() - 1;
  ASSERT_EQ(scan->part[last], 2u);
  EXPECT_NEAR(scan->range[last], 6 + 0.5 * 0.4, 1e-3);  // (n - 1) times its depth
  EXPECT_NEAR(scan->intensity[last], 50 * std::pow(0.96, 4), 0.1);
}

TEST(LidarReturnsOf, ModesPickFirstStrongestAndLast) {
  SceneBuilder b;
  MaterialDescription net;  // lets half of the light through
  net.opacity = 0.5f;
  net.base_color = {0.02f, 0.02f, 0.02f};
  net.specular_weight = 0;
  add_wall(&b, {0.001f, 2, 2}, {3, 0, 0}, b.add_material(net));
  net.base_color = {0.9f, 0.9f, 0.9f};
  add_wall(&b, {0.001f, 2, 2}, {5, 0, 0}, b.add_material(net));
  add_wall(&b, {0.5f, 50, 50}, {8.5f, 0, 0}, b.add_diffuse({0.1f, 0.1f, 0.1f}));
  const auto ranges = [&](const char* mode) {
    LidarOptions options = pencil();
    options.returns = mode;
    std::vector<int> rounded;
    const auto scan = scan_scene(b, options);
    for (const float r : scan->range) rounded.push_back(static_cast<int>(std::lround(r)));
    return rounded;
  };
  EXPECT_EQ(ranges("first"), std::vector<int>{3});
  EXPECT_EQ(ranges("strongest"), std::vector<int>{5});
  EXPECT_EQ(ranges("last"), std::vector<int>{8});
  EXPECT_EQ(ranges("dual"), (std::vector<int>{5, 8}));
  EXPECT_EQ(ranges("all"), (std::vector<int>{3, 5, 8}));
}

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
  const Moments range = moments(scan->range), amplitude = moments(scan->intensity);
  const double n = static_cast<double>(range.n);
  EXPECT_NEAR(range.mean, 20, 3 * wanted / std::sqrt(n));
  EXPECT_NEAR(range.deviation, wanted, 3 * wanted / std::sqrt(2 * n));
  EXPECT_NEAR(amplitude.mean, signal, 3 * noise / std::sqrt(n));
  EXPECT_NEAR(amplitude.deviation, noise, 3 * noise / std::sqrt(2 * n));
  double product = 0;
  for (size_t i = 0; i + 1 < scan->size(); ++i)
    product += (scan->range[i] - range.mean) * (scan->range[i + 1] - range.mean);
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

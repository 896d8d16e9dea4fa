// What LiDARs report: intensity, drop-outs, several returns.

#include <algorithm>
#include <cmath>

#include "sensors/test/lidar_scene.h"

namespace gloam {
namespace {

MaterialDescription pane_material(bool thin) {
  MaterialDescription m;
  m.base_color = {0, 0, 0};
  m.transmission_weight = 1;
  m.roughness = 0;
  m.thin_walled = thin;
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

// Water is clear to the eye and dark to these.
TEST(LidarReturnsOf, WhatABlockAbsorbsInTheInfraredIsNotWhatItsColourSays) {
  MaterialDescription water = pane_material(false);
  water.infrared_absorption = {0.5f, 1000};
  const auto behind = [&](double wavelength) {
    SceneBuilder b;
    add_wall(&b, {0.2f, 2, 2}, {3, 0, 0}, b.add_material(water));
    add_wall(&b, {0.5f, 50, 50}, {6.5f, 0, 0}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
    LidarOptions options = pencil();
    options.wavelength = wavelength;
    const auto scan = scan_scene(b, options);
    const auto last = scan->size() - 1;
    return scan->part[last] == 2 ? scan->intensity[last] : 0.0f;
  };
  EXPECT_NEAR(behind(905), 50 * std::pow(0.96, 4) * std::exp(-2 * 0.5 * 0.4), 0.1);
  EXPECT_EQ(behind(1550), 0) << "nothing comes back through 0.4 m";
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

TEST(LidarHides, BeamsPassTheHousingTheyComeFromAndWhatHangsOnIt) {
  SceneBuilder b;
  const int gray = b.add_diffuse({0.5f, 0.5f, 0.5f});
  add_wall(&b, {0.5f, 50, 50}, {10.5f, 0, 0}, gray);
  const int head = b.add_body({});
  b.add(ShapeType::kSphere, {0.1f, 0, 0}, {}, gray, head);
  MaterialDescription glass;
  glass.transmission_weight = 1;
  b.add(ShapeType::kBox, {0.1f, 1, 1}, translation({1, 0, 0}), b.add_material(glass), head);
  EXPECT_NEAR(scan_scene(b, pencil())->range[0], 0.1f, 1e-4f)
      << "without it the shell is in the way";
  auto renderer = make_cpu_renderer(b.description);
  ASSERT_TRUE(renderer.ok());
  std::vector<uint8_t> hidden(static_cast<size_t>(head) + 1);
  hidden.back() = 1;
  auto sensor = LidarSensor::create(b.description, {pencil(), 0, {}, hidden}, 1);
  ASSERT_TRUE(sensor.ok());
  RenderTurns turns;
  const PoseFrame keys[] = {b.frame, b.frame};
  const auto scan = (*sensor)->scan(**renderer, turns, keys, 0);
  ASSERT_EQ(scan->size(), 1u);
  EXPECT_NEAR(scan->range[0], 10, 1e-4f);
  EXPECT_NEAR(scan->intensity[0], 50, 0.1);
}

}  // namespace
}  // namespace gloam

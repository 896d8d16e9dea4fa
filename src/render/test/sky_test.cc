// Environment maps, photometric profiles, schedules and one-sided emitters in whole pictures.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

EnvironmentDescription even_map(Vec3f luminance) {
  return {"even", 64, 32, std::vector<Vec3f>(64 * 32, luminance)};
}

/// A dim sky with a bright, small disc about the direction (1, 0, 1).
EnvironmentDescription sunny_map() {
  EnvironmentDescription map{"sunny", 256, 128, {}};
  const Vec3f to_sun = normalize(Vec3f{1, 0, 1});
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const float theta = kPi * (static_cast<float>(row) + 0.5f) / 128;
      const float phi = 2 * kPi * (0.5f - (static_cast<float>(column) + 0.5f) / 256);
      const Vec3f d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta)};
      map.texels.push_back(dot(d, to_sun) > 0.999f ? Vec3f{9000, 8000, 6000} : Vec3f{1, 2, 3});
    }
  }
  return map;
}

CameraView floor_view() { return SceneBuilder::camera(look_at({0, -2, 3}, {0, 0, 0}), 24, 24, 20); }

TEST(Sky, WhiteFurnaceUnderAMapReturnsAllLight) {
  for (const float roughness : {0.1f, 0.5f}) {
    SceneBuilder b;
    b.description.sky.environment = even_map({2, 2, 2});
    MaterialDescription m;
    m.base_color = {1, 1, 1};
    m.metallic = 1;
    m.roughness = roughness;
    b.add(ShapeType::kSphere, {1, 0, 0}, {}, b.add_material(m));
    const CameraView view = SceneBuilder::camera(look_at({4, 3, 2}, {0, 0, 0}), 24, 24, 14);
    const Mean mean = picture_mean(b.render(view, settings_of(128)));
    EXPECT_NEAR(mean.mean, 2, 4 * mean.standard_error() + 0.01) << "roughness " << roughness;
  }
}

/// Under a map, with `walls` about it that the light guide finds the sky above.
SceneBuilder sunlit(bool walls) {
  SceneBuilder b;
  b.description.sky.environment = sunny_map();
  b.description.sky.environment.turn = 0.5f;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  b.add(ShapeType::kBox, {0.2f, 0.2f, 0.2f}, translation({0.2f, 0.3f, 0.2f}),
        b.add_diffuse({0.7f, 0.7f, 0.7f}));
  if (!walls) return b;
  const int wall = b.add_diffuse({0.6f, 0.6f, 0.6f});
  for (const float side : {-1.0f, 1.0f}) {
    b.add(ShapeType::kBox, {0.1f, 3, 2}, translation({side * 2, 0, 2}), wall);
    b.add(ShapeType::kBox, {3, 0.1f, 2}, translation({0, side * 4, 2}), wall);
  }
  LightDescription lamp;
  lamp.intensity = {5, 5, 5};
  b.add_light(lamp, {0, 1, 1.5f});
  return b;
}

/// Mean of the view's radiance when the map's light is found by BSDFs alone.
Mean without_sampling(const SceneBuilder& b, int paths) {
  Probe probe(b);
  probe.view.environment.row_cdf = {};
  const CameraView view = floor_view();
  CameraView32 camera;
  camera.fx = camera.fy = static_cast<float>(view.intrinsics.fx);
  camera.cx = camera.cy = 12;
  camera.pose = {view.X_WC_open, view.X_WC_open, {}};
  Mean mean;
  for (int i = 0; i < paths; ++i) {
    Sampler sampler = draw(static_cast<uint32_t>(i));
    const Vec2f at = sampler.next_2d();
    RayCone cone;
    const Ray ray = camera_ray(camera, at.x * 24, at.y * 24, 0, &cone);
    mean.add(trace_path(probe.view, probe.tracer, ray, 0.0f, 0.0f, {3, 100}, sampler).radiance.x);
  }
  return mean;
}

TEST(Sky, SamplingAMapChangesTheNoiseAndNotTheMean) {
  for (const bool walls : {false, true}) {
    const SceneBuilder b = sunlit(walls);
    const Mean sampled = picture_mean(b.render(floor_view(), settings_of(64, 3)));
    const Mean found = without_sampling(b, 1 << 20);
    const double error = std::hypot(sampled.standard_error(), found.standard_error());
    EXPECT_NEAR(sampled.mean, found.mean, 4 * error) << "walls " << walls;
    // 36,864 samples against a million.
    EXPECT_LT(sampled.standard_error(), found.standard_error()) << "walls " << walls;
  }
}

TEST(Sky, LampsAndMapAddUp) {
  for (const int count : {3, 20}) {  // weighed one by one, and by power
    SceneBuilder b;
    b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
    LightDescription lamp;
    lamp.intensity = {10, 10, 10};
    for (int i = 0; i < count; ++i) b.add_light(lamp, {0.1f * static_cast<float>(i), 0.2f, 1.5f});
    const Mean lamps = picture_mean(b.render(floor_view(), settings_of(256, 2)));
    b.description.sky.environment = even_map({10, 10, 10});
    const Mean both = picture_mean(b.render(floor_view(), settings_of(256, 2)));
    EXPECT_NEAR(both.mean, lamps.mean + 5,
                4 * std::hypot(both.standard_error(), lamps.standard_error()))
        << count << " lamps";
  }
}

/// Illuminance on the floor at x below a lamp at height 2, from the radiance of white paint.
double floor_light(const SceneBuilder& b, float x) {
  const CameraView view = SceneBuilder::camera(look_at({x, -0.01f, 1}, {x, 0, 0}), 2, 2, 0.5);
  return picture_mean(b.render(view, settings_of(64, 2))).mean * kPi;
}

SceneBuilder floor_below(const LightDescription& lamp, const Affine3f& X_BL, int body_at_height) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({1, 1, 1}));
  LightDescription light = lamp;
  light.body = b.add_body(translation({0, 0, static_cast<float>(body_at_height)}));
  light.X_BL = X_BL;
  b.description.lights.push_back(light);
  return b;
}

TEST(Sky, LampsShineByTheirProfile) {
  IesProfile profile;  // intensities at 0, 45, 90, 135 and 180 degrees, four columns
  profile.rows = 5;
  profile.columns = 4;
  for (const float along : {1.0f, 0.75f, 0.5f, 0.0f, 0.0f}) {
    for (const float around : {1.0f, 0.8f, 0.6f, 0.4f}) {
      profile.candela.push_back(200 * along * (along == 1 ? 1 : around));
    }
  }
  profile.most = 200;
  for (const float radius : {0.0f, 0.02f}) {
    LightDescription lamp;
    lamp.intensity = {500, 500, 500};
    lamp.profile = 0;
    lamp.radius = radius;
    SceneBuilder b = floor_below(lamp, {}, 2);
    b.description.ies_profiles.push_back(profile);
    EXPECT_NEAR(floor_light(b, 0), 125, 1) << "straight below, 500 cd at 2 m";
    // At 45 degrees: 2 sqrt(2) m away, slanted; +X is the first column, -X the third.
    const double slanted = 500 / 8.0 * std::sqrt(0.5);
    EXPECT_NEAR(floor_light(b, 2), 0.75 * slanted, 0.3);
    EXPECT_NEAR(floor_light(b, -2), 0.75 * 0.6 * slanted, 0.3);
    // Turned by a quarter about the axis: the second column lies along -X then.
    b = floor_below(lamp, rigid({0, 0, 1}, kPi / 2, {}), 2);
    b.description.ies_profiles.push_back(profile);
    EXPECT_NEAR(floor_light(b, -2), 0.75 * 0.8 * slanted, 0.3);
  }
}

TEST(Sky, LampsMoveWithTheirBody) {
  LightDescription lamp;
  lamp.type = PunctualLightType::kSpot;
  lamp.cos_cutoff = std::cos(0.5f);
  lamp.intensity = {400, 400, 400};
  EXPECT_NEAR(floor_light(floor_below(lamp, {}, 2), 0), 100, 1);
  EXPECT_NEAR(floor_light(floor_below(lamp, {}, 4), 0), 25, 0.3);
  EXPECT_EQ(floor_light(floor_below(lamp, rigid({1, 0, 0}, kPi, {}), 2), 0), 0) << "it looks up";
}

TEST(Sky, LampsFollowTheirSchedule) {
  LightDescription lamp;
  lamp.intensity = {400, 400, 400};
  lamp.schedule = 0;
  SceneBuilder b = floor_below(lamp, {}, 2);
  b.description.schedules.push_back({{OnOff{1.0, 0.25, 0}}});
  MaterialDescription panel;
  panel.base_color = {0, 0, 0};
  panel.specular_weight = 0;
  panel.emission = {100, 100, 100};
  panel.schedule = 0;
  b.add(ShapeType::kSphere, {0.1f, 0, 0}, translation({0, 0, 1.5f}), b.add_material(panel));
  const auto renderer = b.make();
  const CameraView view = SceneBuilder::camera(look_at({1, 0, 1.5f}, {0, 0, 1.5f}), 4, 4, 1);
  const auto seen = [&](double open, double close) {
    PoseFrame first = b.frame, last = b.frame;
    first.time = open;
    last.time = close;
    renderer->update(first, last, first);
    Film film;
    renderer->render(view, settings_of(4), &film);
    return film.radiance[5].x;
  };
  EXPECT_FLOAT_EQ(seen(0.1, 0.1), 100);
  EXPECT_FLOAT_EQ(seen(0.5, 0.5), 0);
  EXPECT_FLOAT_EQ(seen(1.0, 1.5), 50) << "on for half of the time that the shutter is open";
  EXPECT_FLOAT_EQ(seen(2.1, 2.1), 100) << "after it was off";
  b.frame.time = 0.1;
  EXPECT_GT(floor_light(b, 0.5f), 10);
  b.frame.time = 0.6;
  EXPECT_EQ(floor_light(b, 0.5f), 0);
}

TEST(Sky, PanelsThatEmitOutwardsHaveADarkBack) {
  const auto panel = [](bool up, bool outwards) {
    SceneBuilder b;
    b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({1, 1, 1}));
    TriangleMesh square;
    square.positions = {{-0.1f, -0.1f, 0}, {0.1f, -0.1f, 0}, {0.1f, 0.1f, 0}, {-0.1f, 0.1f, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    MaterialDescription m;
    m.base_color = {0, 0, 0};
    m.specular_weight = 0;
    m.emission = {1000, 1000, 1000};
    m.emits_outwards = outwards;
    b.add(ShapeType::kMesh, {}, rigid({1, 0, 0}, up ? 0.0f : kPi, {0, 0, 2}), b.add_material(m), 0,
          b.add_mesh(square));
    return floor_light(b, 0);
  };
  const double down = panel(false, true);
  EXPECT_NEAR(down, 1000 * 0.04 / 4, 0.1);  // L A cos cos / d²
  EXPECT_EQ(panel(true, true), 0);
  EXPECT_NEAR(panel(true, false), down, 0.1) << "plain meshes shine to both sides";
}

TEST(Sky, BadReferencesAreRefused) {
  SceneBuilder b = floor_below({}, {}, 2);
  b.description.lights[0].profile = 0;
  EXPECT_FALSE(make_cpu_renderer(b.description).ok()) << "no such profile";
  b.description.lights[0].profile = -1;
  b.description.lights[0].schedule = 3;
  EXPECT_FALSE(make_cpu_renderer(b.description).ok()) << "no such schedule";
  b.description.lights[0].schedule = -1;
  b.description.sky.environment = {"short", 4, 4, std::vector<Vec3f>(15)};
  EXPECT_FALSE(make_cpu_renderer(b.description).ok()) << "a texel is missing";
}

}  // namespace
}  // namespace gloam

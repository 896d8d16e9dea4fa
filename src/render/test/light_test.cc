// Radiance against closed forms.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

/// Luminance of a Lambertian plane of albedo 0.5 seen around the origin, and its standard error.
Mean plane_luminance(SceneBuilder b, int spp = 256, int max_depth = 2, Vec3f at = {0, 0, 0}) {
  b.add(ShapeType::kPlane, {0, 0, 0}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
  RenderSettings settings;
  settings.spp = spp;
  settings.max_depth = max_depth;
  settings.variance = true;
  // A narrow view: the plane is a point to it.
  const CameraView view = SceneBuilder::camera(look_at(at + Vec3f{3, -4, 5}, at), 8, 8, 0.02);
  return picture_mean(b.render(view, settings));
}

void expect_luminance(const Mean& mean, double expected, double relative = 2e-3) {
  EXPECT_NEAR(mean.mean, expected, 4 * mean.standard_error() + relative * expected);
}

TEST(Light, PointOverLambertPlane) {
  SceneBuilder b;
  LightDescription light;
  light.intensity = {100, 100, 100};
  b.add_light(light, {1, 0, 2});
  // E = I cos / d², L = albedo E / pi.
  expect_luminance(plane_luminance(b), 0.5 / M_PI * 100 * (2 / std::sqrt(5.0)) / 5);
}

TEST(Light, LuminousSphereIsThePointOfItsIntensity) {
  SceneBuilder b;
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.radius = 0.5f;
  b.add_light(light, {1, 0, 2});
  // Wholly above the horizon a sphere lights as a point at its centre (view factor r²/d² cos).
  expect_luminance(plane_luminance(b), 0.5 / M_PI * 100 * (2 / std::sqrt(5.0)) / 5);
}

TEST(Light, EmissiveSphere) {
  SceneBuilder b;
  b.add(ShapeType::kSphere, {0.5f, 0, 0}, translation({1, 0, 2}), b.add_emitter({80, 80, 80}));
  // E = pi L (r/d)² cos.
  expect_luminance(plane_luminance(b), 0.5 * 80 * 0.25 / 5 * (2 / std::sqrt(5.0)));
}

TEST(Light, DirectionalWithAndWithoutDisc) {
  for (const float radius : {0.0f, 0.2f}) {
    SceneBuilder b;
    LightDescription light;
    light.type = PunctualLightType::kDirectional;
    light.intensity = {100, 100, 100};
    light.radius = radius;
    b.add_light(light, {0, 0, 5}, normalize(Vec3f{0.6f, 0, -0.8f}));
    expect_luminance(plane_luminance(b), 0.5 / M_PI * 100 * 0.8);
  }
}

TEST(Light, SpotShinesInItsConeAndFades) {
  LightDescription light;
  light.type = PunctualLightType::kSpot;
  light.intensity = {100, 100, 100};
  light.cos_cutoff = std::cos(0.5f);
  light.softness = 0.4f;
  const auto luminance_at = [&](float angle) {
    SceneBuilder b;
    b.add_light(light, {-2 * std::tan(angle), 0, 2});
    return plane_luminance(b).mean * M_PI / 0.5 / (100 * std::pow(std::cos(angle), 3) / 4);
  };
  EXPECT_NEAR(luminance_at(0.0f), 1, 1e-3);
  EXPECT_NEAR(luminance_at(0.29f), 1, 2e-3);   // full intensity within 0.6 of the half angle
  EXPECT_NEAR(luminance_at(0.4f), 0.5, 5e-3);  // half-way through the penumbra
  EXPECT_EQ(luminance_at(0.51f), 0);
}

TEST(Light, HeadlightSitsAtTheCamera) {
  SceneBuilder b;
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.light = -1;
  b.description.lights.push_back(light);
  const double d = std::sqrt(50.0), cosine = 5 / d;
  expect_luminance(plane_luminance(b), 0.5 / M_PI * 100 * cosine / 50);
}

TEST(Light, RectangleHasItsFormFactor) {
  // Parallel rectangle of 2a x 2b at height h above the point: view factor of a differential plane
  // element, four times that of a corner (Howell, "A catalog of radiation heat transfer
  // configuration factors", B-4).
  SceneBuilder b;
  const double half_a = 0.5, half_b = 0.3, h = 1.0;
  b.add(ShapeType::kPlane, {0.5f, 0.3f, 0}, rigid({1, 0, 0}, kPi, {0, 0, 1}),
        b.add_emitter({200, 200, 200}));
  const double x = half_a / h, y = half_b / h;
  const double corner = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                         y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                        (2 * M_PI);
  expect_luminance(plane_luminance(b, 1024), 0.5 * 200 * 4 * corner);
}

TEST(Light, MeshEmitterEqualsAnalyticOne) {
  // A box of triangles against the analytic box.
  SceneBuilder analytic, mesh;
  const Affine3f pose = rigid(normalize(Vec3f{1, 1, 0}), 0.5f, {0.5f, 0.2f, 1.0f});
  analytic.add(ShapeType::kBox, {0.3f, 0.2f, 0.1f}, pose, analytic.add_emitter({200, 200, 200}));
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.positions.push_back(
        {(i & 1) != 0 ? 0.3f : -0.3f, (i & 2) != 0 ? 0.2f : -0.2f, (i & 4) != 0 ? 0.1f : -0.1f});
  }
  box.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  mesh.add(ShapeType::kMesh, {}, pose, mesh.add_emitter({200, 200, 200}), 0, mesh.add_mesh(box));
  const Mean a = plane_luminance(analytic, 2048), m = plane_luminance(mesh, 2048);
  EXPECT_NEAR(a.mean, m.mean, 4 * std::hypot(a.standard_error(), m.standard_error()));
  EXPECT_GT(a.mean, 1);
}

TEST(Light, LightsAddUp) {
  const auto with = [](bool first, bool second, bool third) {
    SceneBuilder b;
    LightDescription light;
    light.intensity = {100, 100, 100};
    light.radius = 0.1f;
    if (first) b.add_light(light, {1, 0, 2});
    light.intensity = {5, 5, 5};
    if (second) b.add_light(light, {-1, 1, 1});
    if (third) {
      b.add(ShapeType::kCapsule, {0.1f, 0.4f, 0}, translation({0, -1, 1}),
            b.add_emitter({50, 50, 50}));
    }
    return plane_luminance(b, 1024);
  };
  const Mean all = with(true, true, true), a = with(true, false, false),
             c = with(false, true, false), d = with(false, false, true);
  EXPECT_NEAR(all.mean, a.mean + c.mean + d.mean,
              4 * std::hypot(all.standard_error(), d.standard_error()) + 1e-3 * all.mean);
}

TEST(Light, ManyLightsAddUpWithoutBias) {
  SceneBuilder b;
  LightDescription light;
  double expected = 0;
  for (int i = 0; i < 50; ++i) {
    light.intensity = Vec3f{1, 1, 1} * static_cast<float>(1 + i % 7);
    const Vec3f p{std::cos(static_cast<float>(i)) * 2, std::sin(static_cast<float>(i)) * 2, 2};
    b.add_light(light, p);
    const double d2 = dot(p, p);
    expected += 0.5 / M_PI * light.intensity.x * 2 / std::sqrt(d2) / d2;
  }
  expect_luminance(plane_luminance(b, 1024), expected);
}

TEST(Light, ShadowlessLightPassesBlockers) {
  SceneBuilder b;
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.radius = 0.1f;
  light.casts_shadow = false;
  b.add_light(light, {0, 0, 2});
  b.add(ShapeType::kBox, {1, 1, 0.1f}, translation({0, 0, 1}), b.add_diffuse({0, 0, 0}));
  // Seen from the side, under the box.
  SceneBuilder lit = b, dark = b;
  lit.add(ShapeType::kPlane, {}, {}, lit.add_diffuse({0.5f, 0.5f, 0.5f}));
  RenderSettings settings;
  settings.spp = 64;
  settings.max_depth = 2;
  const CameraView view = SceneBuilder::camera(look_at({5, 0, 0.5f}, {0, 0, 0}), 4, 4, 0.02);
  EXPECT_NEAR(lit.render(view, settings).radiance[0].x, 0.5 / M_PI * 25, 0.05);
  lit.description.lights[0].casts_shadow = true;
  EXPECT_EQ(lit.render(view, settings).radiance[0].x, 0);
}

TEST(Light, SkyAndAmbientFollowTheirRules) {
  SceneBuilder b;
  Image8 face{4, 4, 3, ColorSpace::kLinear, std::vector<uint8_t>(48, 255)};
  b.description.textures.push_back({"sky", std::vector<Image8>(6, face)});
  b.description.sky.texture = 0;
  b.description.sky.scale = 10;
  // A plane under a constant sky of luminance L has luminance albedo L.
  expect_luminance(plane_luminance(b), 5);
  b.description.sky.ambient = {4, 4, 4};
  expect_luminance(plane_luminance(b), 7);
  // The camera sees the texture only.
  RenderSettings settings;
  settings.spp = 4;
  const Film film = b.render(SceneBuilder::camera(look_at({0, 0, 1}, {0, 0, 5}), 4, 4), settings);
  EXPECT_NEAR(film.radiance[0].x, 10, 1e-3);
}

TEST(Light, SkyFacesStandWhereMujocoPutsThem) {
  // right, left, up, down, front, back in distinct greys; MuJoCo's default camera looks along +Y at
  // the back face, +X is right, +Z is up.
  SceneBuilder b;
  std::vector<Image8> faces;
  for (uint8_t i = 0; i < 6; ++i) {
    faces.push_back({2, 2, 1, ColorSpace::kLinear, std::vector<uint8_t>(4, uint8_t(40 * i + 20))});
  }
  b.description.textures.push_back({"sky", faces});
  b.description.sky.texture = 0;
  b.description.sky.scale = 255;
  RenderSettings settings;
  settings.spp = 1;
  const Vec3f directions[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, 1, 0}};
  for (int i = 0; i < 6; ++i) {
    const Film film =
        b.render(SceneBuilder::camera(look_at({}, directions[i]), 2, 2, 10), settings);
    EXPECT_NEAR(film.radiance[0].x, 40 * i + 20, 0.05) << "face " << i;
  }
}

TEST(Light, LampsShowInMirrorsButNotToTheCamera) {
  SceneBuilder b;
  LightDescription light;
  light.intensity = {100, 100, 100};
  light.radius = 0.3f;
  b.add_light(light, {0, 0, 3});
  MaterialDescription mirror;
  mirror.base_color = {1, 1, 1};
  mirror.metallic = 1;
  mirror.roughness = 0;
  b.add(ShapeType::kPlane, {}, {}, b.add_material(mirror));
  RenderSettings settings;
  settings.spp = 64;
  settings.max_depth = 3;
  settings.variance = true;
  const Film down =
      b.render(SceneBuilder::camera(look_at({0, 0, 1}, {0, 0, 0}), 4, 4, 0.5), settings);
  EXPECT_NEAR(down.radiance[5].x, 100 / (M_PI * 0.09), 4);
  const Film up =
      b.render(SceneBuilder::camera(look_at({0, 0, 1}, {0, 0, 3}), 4, 4, 0.5), settings);
  EXPECT_EQ(up.radiance[5].x, 0);
}

}  // namespace
}  // namespace gloam

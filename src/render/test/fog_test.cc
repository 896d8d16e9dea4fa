// Participating media in whole pictures of the path tier.

#include <gtest/gtest.h>

#include "render/test/media_probe.h"
#include "world/lights/black_body.h"

namespace gloam {
namespace {

/// A scene with one even medium in a box.
SceneBuilder with_fog(Vec3f size, Vec3f center, Vec3f extinction, Vec3f albedo, Vec3f g = {},
                      float emission = 0, float temperature = 293) {
  MediaBuilder fog;
  VolumeDescription& box =
      fog.add_box(size, center, 1, fog.add_medium(extinction, albedo, g, emission));
  box.even_temperature = temperature;
  SceneBuilder b;
  b.description.media = fog.media;
  b.description.volumes = fog.volumes;
  return b;
}

CameraView narrow_view(Vec3f eye, Vec3f target) {
  return SceneBuilder::camera(look_at(eye, target), 8, 8, 1);
}

Vec3f mean_color(const Film& film) {
  Vec3f sum;
  for (const Vec3f& v : film.radiance) sum += v;
  return sum / static_cast<float>(film.radiance.size());
}

TEST(Fog, WhatIsBehindAbsorbingMediaDimsByBeerLambert) {
  for (const bool glass : {false, true}) {
    SceneBuilder b = with_fog({2, 2, 2}, {0, 0, 0}, {0.3f, 0.8f, 1.5f}, {});
    b.add(ShapeType::kBox, {1, 0.1f, 1}, translation({0, 3, 0}), b.add_emitter({100, 100, 100}));
    if (glass) {  // half of the light passes a pane in the middle of it
      MaterialDescription pane;
      pane.base_color = {0, 0, 0};
      pane.specular_weight = 0;
      pane.opacity = 0.5f;
      b.add(ShapeType::kBox, {1, 1e-4f, 1}, {}, b.add_material(pane));
    }
    const Film film = b.render(narrow_view({0, -4, 0}, {0, 0, 0}), settings_of(4096, 3));
    const Vec3f seen = mean_color(film);
    const float pane = glass ? 0.25f : 1.0f;  // it has two faces
    EXPECT_NEAR(seen.x, 100 * pane * std::exp(-0.6f), 0.6f) << "glass " << glass;
    EXPECT_NEAR(seen.y, 100 * pane * std::exp(-1.6f), 0.5f);
    EXPECT_NEAR(seen.z, 100 * pane * std::exp(-3.0f), 0.3f);
  }
}

TEST(Fog, ShadowRaysDimToo) {
  SceneBuilder b = with_fog({8, 8, 1}, {0, 0, 1}, {0.4f, 0.8f, 1.6f}, {});
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({1, 1, 1}));
  LightDescription lamp;
  lamp.intensity = {100, 100, 100};
  const CameraView view = narrow_view({0, -0.01f, 0.4f}, {0, 0, 0});
  for (const bool casts_shadow : {true, false}) {
    for (const float radius : {0.0f, 0.05f}) {
      lamp.casts_shadow = casts_shadow;
      lamp.radius = radius;
      SceneBuilder lit = b;
      lit.add_light(lamp, {0, 0, 2});
      const Vec3f seen = mean_color(lit.render(view, settings_of(256, 3))) * kPi;
      EXPECT_NEAR(seen.x, 25 * std::exp(-0.4f), 0.2f) << casts_shadow << radius;
      EXPECT_NEAR(seen.y, 25 * std::exp(-0.8f), 0.2f);
      EXPECT_NEAR(seen.z, 25 * std::exp(-1.6f), 0.2f);
    }
  }
}

TEST(Fog, LampsInMirrorsDimOnBothWays) {
  SceneBuilder b = with_fog({8, 8, 1}, {0, 0, 1}, {0.7f, 0.7f, 0.7f}, {});
  MaterialDescription mirror;
  mirror.base_color = {1, 1, 1};
  mirror.metallic = 1;
  mirror.roughness = 0.05f;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_material(mirror));
  LightDescription lamp;
  lamp.intensity = {10, 10, 10};
  lamp.radius = 0.3f;
  b.add_light(lamp, {0, 1, 2});
  const CameraView view = narrow_view({0, -1, 2}, {0, 0, 0});
  const Mean fog = picture_mean(b.render(view, settings_of(1024, 3)));
  SceneBuilder clear = b;
  clear.description.volumes.clear();
  const Mean none = picture_mean(clear.render(view, settings_of(1024, 3)));
  // Each way crosses the slab at a cosine of 2 / sqrt(5).
  const double expected = none.mean * std::exp(-2 * 0.7 * std::sqrt(5) / 2);
  EXPECT_NEAR(fog.mean, expected, 4 * fog.standard_error() + 0.02 * expected);
}

TEST(Fog, WhiteMediaInEvenLightCannotBeSeen) {
  for (const float g : {-0.4f, 0.0f, 0.8f}) {
    SceneBuilder b = with_fog({2, 2, 2}, {}, {1, 2, 4}, {1, 1, 1}, {g, g, g});
    b.description.sky.environment = {"even", 64, 32, std::vector<Vec3f>(64 * 32, {3, 3, 3})};
    // A glass pane and a white ball within leave it so.
    MaterialDescription white;
    white.base_color = {1, 1, 1};
    white.specular_weight = 0;
    b.add(ShapeType::kSphere, {0.3f, 0, 0}, {}, b.add_material(white));
    RenderSettings settings = settings_of(256, 200);
    const Film film = b.render(narrow_view({3, 3, 2}, {0, 0, 0}), settings);
    const Mean red = picture_mean(film);
    EXPECT_NEAR(red.mean, 3, 4 * red.standard_error() + 1e-3) << "g " << g;
    EXPECT_NEAR(mean_color(film).z, 3, 0.1) << "g " << g;
  }
}

TEST(Fog, SingleScatteringMatchesItsIntegral) {
  // A lamp beside the view through a thin medium: light scattered once, by quadrature.
  const float k = 0.2f, albedo = 0.7f, g = 0.5f;
  SceneBuilder b = with_fog({4, 4, 4}, {}, {k, k, k}, {albedo, albedo, albedo}, {g, g, g});
  LightDescription lamp;
  lamp.intensity = {100, 100, 100};
  b.add_light(lamp, {0.5f, 0.3f, 3});
  const Vec3f eye{0, -5, 0};
  const Film film = b.render(narrow_view(eye, {0, 0, 0}), settings_of(1024, 2));
  const Mean seen = picture_mean(film);
  double expected = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const float t = 3 + 4 * (static_cast<float>(i) + 0.5f) / kSteps;  // in the box
    const Vec3f p = eye + Vec3f{0, 1, 0} * t, to = Vec3f{0.5f, 0.3f, 3} - p;
    const float d = length(to), inside = d * (2 - p.z) / to.z;
    expected += 100 / (d * d) * k * albedo * henyey_greenstein(g, to.y / d) *
                std::exp(-k * (t - 3 + inside)) * 4 / kSteps;
  }
  EXPECT_NEAR(seen.mean, expected, 4 * seen.standard_error() + 0.003 * expected);
}

TEST(Fog, HotMediaGlow) {
  const float k = 0.5f, temperature = 2000;
  SceneBuilder b = with_fog({2, 2, 2}, {}, {k, k, k}, {}, {}, 1, temperature);
  const Mean seen =
      picture_mean(b.render(narrow_view({0, -4, 0}, {0, 0, 0}), settings_of(4096, 2)));
  const double expected = black_body_luminance(temperature).x * (1 - std::exp(-2 * k));
  EXPECT_NEAR(seen.mean, expected, 4 * seen.standard_error() + 0.01 * expected);
}

TEST(Fog, BadVolumesAreRefused) {
  SceneBuilder b = with_fog({2, 2, 2}, {}, {1, 1, 1}, {});
  b.description.volumes[0].medium = 1;
  EXPECT_FALSE(make_cpu_renderer(b.description).ok()) << "there is one medium";
}

}  // namespace
}  // namespace gloam

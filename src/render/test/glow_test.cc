// Light of media that glow, drawn as that of lamps is: closed forms, and the same light as by
// chance.

#include <gtest/gtest.h>

#include "render/kernel/light/glow_line.h"
#include "render/kernel/path/path_machine.h"
#include "render/test/flame.h"
#include "render/test/media_probe.h"
#include "world/lights/black_body.h"

namespace gloam {
namespace {

/// A room with a mirror, a half transparent board and a shelf that stands in the flame.
SceneBuilder room(float extinction, Vec3f fog, int lamps) {
  SceneBuilder b;
  const int grey = b.add_diffuse({0.6f, 0.5f, 0.4f});
  b.add(ShapeType::kBox, {2, 2, 0.1f}, translation({0, 0, -0.1f}), grey);
  b.add(ShapeType::kBox, {2, 0.1f, 1}, translation({0, 2.1f, 1}), grey);
  b.add(ShapeType::kBox, {0.1f, 2, 1}, translation({-2.1f, 0, 1}), grey);
  b.add(ShapeType::kBox, {0.3f, 0.05f, 0.01f}, translation({0.5f, 0.5f, 0.35f}), grey);
  MaterialDescription metal;
  metal.base_color = {0.9f, 0.9f, 0.9f};
  metal.metallic = 1;
  metal.roughness = 0.2f;
  b.add(ShapeType::kBox, {0.05f, 0.6f, 0.6f}, translation({1.8f, 0, 0.8f}), b.add_material(metal));
  MaterialDescription board;
  board.base_color = {0.5f, 0.2f, 0.2f};
  board.opacity = 0.5f;
  b.add(ShapeType::kBox, {0.4f, 0.01f, 0.4f}, translation({-0.3f, 0.9f, 0.5f}),
        b.add_material(board));
  for (int i = 0; i < lamps; ++i) {
    LightDescription lamp;
    lamp.intensity = {0.3f, 0.3f, 0.3f};
    b.add_light(lamp, {-1.5f + 0.15f * static_cast<float>(i), -1, 1.7f});
  }
  add_flame(&b, {0.5f, 0.5f, 0}, extinction, fog);
  return b;
}

Ray view_ray(uint32_t i) {
  Sampler sampler = draw(i, 3);
  const Vec2f u = sampler.next_2d();
  return make_ray({-1.5f, -1.8f, 1.2f}, {1.8f * u.x - 0.3f, 1.6f, 1.1f * u.y - 1.0f});
}

TEST(Glow, PointsAreDrawnByTheirDensity) {
  SceneBuilder b;
  add_flame(&b, {}, 2);
  const Probe probe(b);
  const MediaView& media = probe.view.media;
  ASSERT_EQ(media.glows.size, 1u);
  const GlowView& glow = media.glows[0];
  const VolumeView& volume = media.volumes[0];
  const Vec3f p{1.2f, -0.7f, 0.3f};
  double expected = 0;  // of emission / distance², by the midpoint rule
  constexpr int kPerVoxel = 4;
  for (int i = 0; i < 20 * 20 * 40 * kPerVoxel * kPerVoxel * kPerVoxel; ++i) {
    constexpr int kX = 20 * kPerVoxel;
    const int x = i % kX, y = i / kX % kX, z = i / (kX * kX);
    const Vec3f p_G = (Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} +
                       Vec3f{0.5f, 0.5f, 0.5f}) *
                      (1.0f / kPerVoxel);
    const float power =
        0.7f * 2 * media::density_at(volume, p_G) * media::glow_at(media, volume, p_G, {}).x;
    expected += static_cast<double>(power / length_squared(transform_point(glow.X_WG, p_G) - p) /
                                    (glow.voxels_per_volume * kPerVoxel * kPerVoxel * kPerVoxel));
  }
  Mean drawn;
  for (uint32_t i = 0; i < 100000; ++i) {
    Sampler sampler = independent(i, 5);
    const LightSample s = glow::sample(media, glow, p, sampler.next_2d());
    drawn.add(s.pdf > 0 ? s.radiance.x / s.pdf : 0);
    if (!(s.pdf > 0)) continue;
    const Vec3f x = p + s.wi * s.distance, p_G = transform_point(volume.X_GW, x);
    const float wall =
        min(min(p_G.x - floorf(p_G.x), p_G.y - floorf(p_G.y)), p_G.z - floorf(p_G.z));
    if (wall < 1e-3f || wall > 1 - 1e-3f) continue;  // its voxel may be taken for the next
    ASSERT_NEAR(glow::pdf(media, glow, p, x, p_G), s.pdf, 1e-3f * s.pdf) << "draw " << i;
  }
  EXPECT_NEAR(drawn.mean, expected, 4 * drawn.standard_error() + 2e-3 * expected);
  // The remaining difference: a voxel is not homogeneous, and some voxels are farther away.
  EXPECT_LT(drawn.standard_error(), 1.0 / std::sqrt(100000.0) * expected);
}

TEST(Glow, LinesBringTheLightOfPoints) {
  for (const float extinction : {2.0f, 60.0f}) {
    SceneBuilder b;
    add_flame(&b, {}, extinction);
    const Probe probe(b);
    const MediaView& media = probe.view.media;
    const Vec3f p{1.2f, -0.7f, 0.3f};
    const auto arrives = [&](const LightSample& s, float clear, Vec2f u) {
      if (!(s.pdf > 0)) return 0.0f;
      const Ray ray = make_ray(p, s.wi);
      return s.radiance.x / s.pdf * transmittance(media, ray, clear, {}, WalkRandom(u)).x;
    };
    Mean points, lines;
    for (uint32_t i = 0; i < 100000; ++i) {
      Sampler sampler = independent(i, 5);
      const Vec2f u = sampler.next_2d(), walk = sampler.next_2d();
      const LightSample point = glow::sample(media, p, {}, u);
      points.add(arrives(point, point.distance, walk));
      const glow::LineSample line = glow::sample_line(media, p, {}, u);
      lines.add(arrives(line.light, line.clear, walk));
    }
    EXPECT_NEAR(lines.mean, points.mean,
                4 * (points.standard_error() + lines.standard_error()) + 0.03 * points.mean)
        << "extinction " << extinction;
  }
}

// There a few of its points are near and bring most of the light, and most are behind others.
TEST(Glow, AtTheFootOfAFlameLinesAreSmooth) {
  SceneBuilder b;
  add_flame(&b, {}, 10, {0.5f, 0.5f, 0.5f});
  const Probe probe(b);
  const MediaView& media = probe.view.media;
  const Vec3f p{0.35f, 0.05f, 0.02f}, n{0, 0, 1};
  constexpr int kCount = 100000;
  Mean points, lines;
  for (uint32_t i = 0; i < kCount; ++i) {
    Sampler sampler = independent(i, 5);
    const Vec2f u = sampler.next_2d(), walk = sampler.next_2d();
    const auto falls = [&](const LightSample& s, float clear) {
      if (!(s.pdf > 0 && s.wi.z > 0)) return 0.0f;
      const Ray ray = make_ray(p, s.wi);
      return s.radiance.x / s.pdf * s.wi.z *
             transmittance(media, ray, clear, {}, WalkRandom(walk)).x;
    };
    const LightSample point = glow::sample(media, p, n, u);
    points.add(point.distance > glow::kNearGlow ? falls(point, point.distance) : 0);
    const glow::LineSample line = glow::sample_line(media, p, n, u);
    lines.add(falls(line.light, line.clear));
  }
  EXPECT_NEAR(lines.mean, points.mean,
              4 * (points.standard_error() + lines.standard_error()) + 0.02 * points.mean);
  EXPECT_LT(lines.standard_error() * std::sqrt(kCount), 0.5 * lines.mean)
      << "pieces of lines had 1.1";
}

TEST(Glow, ThinAndFarAwayItIsAPointLamp) {
  const float k = 0.02f, size = 0.1f, height = 2;
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0.8f, 0.8f, 0.8f}));
  MediaBuilder media;
  media.add_box({size, size, size}, {0, 0, height}, 1, media.add_medium({k, k, k}, {}, {}, 1))
      .even_temperature = kHot;
  b.description.media = media.media;
  b.description.volumes = media.volumes;
  const CameraView view = SceneBuilder::camera(look_at({0.5f, 0, 0.5f}, {}), 8, 8, 1);
  const Mean seen = picture_mean(b.render(view, settings_of(64, 2)));
  const double intensity =
      static_cast<double>(black_body_luminance(kHot).x * k) * std::pow(size, 3);
  const double expected = 0.8 / M_PI * intensity / (height * height);
  EXPECT_NEAR(seen.mean, expected, 4 * seen.standard_error() + 2e-3 * expected);
  EXPECT_LT(seen.standard_error(), 2e-3 * expected)
      << "a flame is drawn like a lamp, not found by chance";
}

TEST(Glow, BringsTheLightThatChanceBrings) {
  const struct {
    float extinction;
    Vec3f fog;
    int lamps;
    const char* name;
  } cases[] = {{3, {}, 0, "a thin flame"},
               {40, {}, 1, "a thick flame and a lamp"},
               {4, {0.2f, 0.25f, 0.3f}, 1, "in fog"},
               {3, {}, 20, "beside many lamps"}};
  for (const auto& c : cases) {
    const Probe probe(room(c.extinction, c.fog, c.lamps));
    ASSERT_TRUE(probe.view.has_glow());
    SceneView by_chance = probe.view;
    by_chance.media.glows = {};
    Mean drawn, found, machine;
    for (uint32_t i = 0; i < 60000; ++i) {
      const Ray ray = view_ray(i);
      const PathOptions options{5, 3};
      const auto trace = [&](const SceneView& view, uint64_t seed) {
        return luminance(
            trace_path(view, probe.tracer, ray, 0.0f, 1e-3f, options, draw(i, seed)).radiance);
      };
      drawn.add(trace(probe.view, 1));
      for (uint64_t k = 0; k < 4; ++k) found.add(trace(by_chance, 5 + k));
      machine.add(luminance(
          run_path(probe.view, probe.tracer, ray, {0, 1e-3f}, options, draw(i, 2)).radiance));
    }
    const double error = std::hypot(drawn.standard_error(), found.standard_error());
    EXPECT_NEAR(drawn.mean, found.mean, 4 * error) << c.name;
    EXPECT_LT(error, 0.04 * found.mean) << c.name << ": too noisy to tell";
    EXPECT_NEAR(machine.mean, drawn.mean,
                4 * std::hypot(drawn.standard_error(), machine.standard_error()))
        << c.name << ", one path after another";
  }
}

TEST(Glow, FillsAClosedWhiteRoomWithItsOwnLuminance) {
  SceneBuilder b;
  const int white = b.add_diffuse({1, 1, 1});
  for (int k = 0; k < 3; ++k) {
    Vec3f half{1.2f, 1.2f, 1.2f}, at;
    (k == 0 ? half.x : (k == 1 ? half.y : half.z)) = 0.1f;
    (k == 0 ? at.x : (k == 1 ? at.y : at.z)) = 1.1f;
    b.add(ShapeType::kBox, half, translation(at), white);
    b.add(ShapeType::kBox, half, translation(-at), white);
  }
  MediaBuilder media;
  const int gas = media.add_medium({1, 2, 3}, {0.5f, 0.4f, 0.2f}, {0.3f, 0, -0.3f}, 1);
  media.add_box({2, 2, 2}, {}, 1, gas).even_temperature = kHot;
  b.description.media = media.media;
  b.description.volumes = media.volumes;
  const CameraView view = SceneBuilder::camera(look_at({-0.8f, -0.7f, 0.2f}, {}), 16, 16, 80);
  const Film film = b.render(view, settings_of(256, 60));
  const Mean seen = picture_mean(film);
  const double expected = static_cast<double>(black_body_luminance(kHot).x);
  EXPECT_NEAR(seen.mean, expected, 4 * seen.standard_error() + 3e-3 * expected);
  EXPECT_LT(seen.standard_error(), 0.01 * expected);
}

TEST(Glow, GoesOutWithItsHeat) {
  MediaBuilder media;
  VolumeDescription flame = make_flame({1, 1, 2}, {});
  media.add(flame, media.add_medium({1, 1, 1}, {}, {}, 1));
  VolumeStore store = media.build();
  ASSERT_EQ(store.view().glows.size, 1u);
  EXPECT_GT(store.view().glows[0].strength, 0.0f);
  flame.temperature = grid_of(std::vector<float>(flame.temperature->size(), 300.0f));
  ASSERT_TRUE(store.replace(0, flame).ok());
  EXPECT_EQ(store.view().glows.size, 0u);
  EXPECT_EQ(store.view().volumes[0].glow, -1);
}

}  // namespace
}  // namespace gloam

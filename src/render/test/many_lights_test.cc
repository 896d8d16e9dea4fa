// Pictures of many lights against the sum of pictures of one.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

constexpr int kLights = 64, kAll = -1;

/// A floor with boxes under 64 lights of all kinds; `only` the one that is on, or kAll. Those that
/// are off still cast shadows.
SceneBuilder hall(int only) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.6f, 0.6f, 0.6f}));
  MaterialDescription steel;
  steel.base_color = {0.8f, 0.8f, 0.8f};
  steel.metallic = 1;
  steel.roughness = 0.3f;
  const int metal = b.add_material(steel);
  b.add(ShapeType::kBox, {1.5f, 1.5f, 0.3f}, translation({1, 1, 0.3f}), metal);
  b.add(ShapeType::kBox, {0.3f, 2, 0.8f}, translation({-2, 0, 0.8f}),
        b.add_diffuse({0.7f, 0.3f, 0.2f}));
  const int black = b.add_diffuse({0, 0, 0}), glow = b.add_emitter({150, 150, 150});
  TriangleMesh small = make_ball(4);
  for (Vec3f& vertex : small.positions) vertex = vertex * 0.1f;
  const int ball = b.add_mesh(small);
  for (int i = 0; i < kLights; ++i) {
    const bool on = only == kAll || only == i;
    const float u = static_cast<float>(i % 8) - 3.5f, v = static_cast<float>(i / 8) - 3.5f;
    const Vec3f p{1.3f * u, 1.3f * v, 1.8f + 0.1f * static_cast<float>(i * 7 % 10)};
    LightDescription lamp;
    lamp.active = on;
    lamp.intensity = Vec3f{1, 1, 1} * static_cast<float>(1 + i % 5);
    const Affine3f turned = rigid(normalize(Vec3f{1, 0.3f, 0}), 2.8f + 0.1f * u, p);
    const int material = on ? glow : black;
    switch (i % 8) {
      case 0:
        b.add_light(lamp, p);
        break;
      case 1:
        lamp.type = PunctualLightType::kSpot;
        lamp.cos_cutoff = std::cos(0.6f);
        lamp.softness = 0.5f;
        b.add_light(lamp, p, normalize(Vec3f{0.1f * u, -0.1f * v, -1}));
        break;
      case 2:
      case 3:
        lamp.radius = 0.15f;
        b.add_light(lamp, p);
        break;
      case 4:
        b.add(ShapeType::kSphere, {0.1f, 0, 0}, translation(p), material);
        break;
      case 5:
        b.add(ShapeType::kBox, {0.2f, 0.1f, 0.03f}, turned, material);
        break;
      case 6:
        b.add(ShapeType::kPlane, {0.2f, 0.1f, 0}, turned, material);
        break;
      default:
        if (i == 7) {
          lamp.type = PunctualLightType::kDirectional;
          lamp.radius = 0.05f;
          b.add_light(lamp, {0, 0, 5}, normalize(Vec3f{0.3f, 0.2f, -1}));
        } else {
          b.add(ShapeType::kMesh, {}, translation(p), material, 0, ball);
        }
    }
  }
  return b;
}

/// Mean and variance of the mean over blocks of the picture.
struct Block {
  double mean = 0, variance = 0;
};
constexpr int kSize = 32, kBlock = 4;
std::vector<Block> blocks_of(const Film& film) {
  std::vector<Block> blocks((kSize / kBlock) * (kSize / kBlock));
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto i = static_cast<size_t>(y * kSize + x);
      Block& block = blocks[static_cast<size_t>(y / kBlock * (kSize / kBlock) + x / kBlock)];
      block.mean += film.radiance[i].x / (kBlock * kBlock);
      block.variance += film.variance[i].x / std::pow(kBlock, 4);
    }
  }
  return blocks;
}

void expect_sum_of_each(RenderSettings settings, int spp) {
  const CameraView view =
      SceneBuilder::camera(look_at({5, -6, 4.5f}, {0, 0, 0.5f}), kSize, kSize, 50);
  settings.variance = true;
  settings.spp = spp;
  const std::vector<Block> all = blocks_of(hall(kAll).render(view, settings));
  std::vector<Block> sum(all.size());
  settings.spp = 128;
  for (int i = 0; i < kLights; ++i) {
    settings.seed = static_cast<uint64_t>(100 + i);
    const std::vector<Block> one = blocks_of(hall(i).render(view, settings));
    for (size_t k = 0; k < sum.size(); ++k) {
      sum[k].mean += one[k].mean;
      sum[k].variance += one[k].variance;
    }
  }
  double chi2 = 0, a = 0, b = 0, error2 = 0;
  for (size_t k = 0; k < all.size(); ++k) {
    const double gap = all[k].mean - sum[k].mean;
    const double variance = all[k].variance + sum[k].variance;
    EXPECT_LT(std::abs(gap), 5 * std::sqrt(variance) + 1e-3 * sum[k].mean) << "block " << k;
    chi2 += gap * gap / variance;
    a += all[k].mean;
    b += sum[k].mean;
    error2 += variance;
  }
  const double n = static_cast<double>(all.size());
  EXPECT_LT(chi2, n + 5 * std::sqrt(2 * n));
  EXPECT_NEAR(a, b, 4 * std::sqrt(error2));
  EXPECT_LT(std::sqrt(error2), 0.01 * b) << "too noisy to compare";
}

TEST(ManyLights, ThePictureIsTheSumOfThoseOfEachLight) {
  RenderSettings settings;
  settings.max_depth = 4;
  expect_sum_of_each(settings, 1024);
}

// The direct tier takes few of many lights, all of one: the mean must not know.
TEST(ManyLights, TheDirectPictureIsTheSumOfThoseOfEachLight) {
  RenderSettings settings;
  settings.tier = RenderTier::kDirect;
  settings.max_depth = 1;  // no ambient light
  expect_sum_of_each(settings, 2048);
}

// A sample is two shadow rays on each surface, however many lights there are.
TEST(ManyLights, ADirectSampleCastsFewShadowRays) {
  RenderSettings settings;
  settings.tier = RenderTier::kDirect;
  settings.spp = 4;
  Film film;
  const CameraView view = SceneBuilder::camera(look_at({5, -6, 4.5f}, {0, 0, 0.5f}), 32, 32, 50);
  const SceneBuilder scene = hall(kAll);
  const RenderStats stats = scene.make()->render(view, settings, &film);
  EXPECT_LE(stats.rays, stats.paths * 4);
}

TEST(ManyLights, AFrameLikeTheLastKeepsThePicture) {
  // The headlight, at the camera, is in the tree too.
  SceneBuilder b = hall(kAll);
  LightDescription head;
  head.type = PunctualLightType::kDirectional;
  head.casts_shadow = false;
  head.intensity = {5, 5, 5};
  b.description.lights.push_back(head);
  RenderSettings settings;
  settings.spp = 8;
  const CameraView here = SceneBuilder::camera(look_at({5, -6, 4.5f}, {0, 0, 0.5f}), 16, 16);
  const CameraView there = SceneBuilder::camera(look_at({-4, 6, 3.5f}, {0, 0, 0.5f}), 16, 16);
  const std::unique_ptr<Renderer> renderer = b.make();
  Film first, other, again, moved, fresh;
  renderer->render(here, settings, &first);
  renderer->render(there, settings, &other);
  renderer->update(b.frame, b.frame, b.frame);
  renderer->render(here, settings, &again);
  EXPECT_EQ(first.radiance, again.radiance);
  b.frame.light_p[0] += 1;  // a lamp moves
  renderer->update(b.frame, b.frame, b.frame);
  renderer->render(here, settings, &moved);
  EXPECT_NE(first.radiance, moved.radiance);
  b.make()->render(here, settings, &fresh);
  EXPECT_EQ(moved.radiance, fresh.radiance) << "the picture depends on those before it";
}

TEST(ManyLights, LightsThatAreNotFiniteAreLeftOut) {
  SceneBuilder b = hall(kAll);
  RenderSettings settings;
  settings.spp = 4;
  const CameraView view = SceneBuilder::camera(look_at({5, -6, 4.5f}, {0, 0, 0.5f}), 16, 16);
  const Film film = b.render(view, settings);
  LightDescription lamp;
  for (const float intensity : {HUGE_VALF, std::nanf(""), -1.0f, 0.0f}) {
    lamp.intensity = Vec3f{1, 1, 1} * intensity;
    b.add_light(lamp, {0, 0, 2});
  }
  lamp.intensity = {1, 1, 1};
  b.add_light(lamp, {std::nanf(""), 0, 2});
  b.add_light(lamp, {HUGE_VALF, 0, 2});
  EXPECT_EQ(b.render(view, settings).radiance, film.radiance);
}

}  // namespace
}  // namespace gloam

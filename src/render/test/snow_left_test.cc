// Snow on bodies that have shed it: both tiers look at what is left.

#include <gtest/gtest.h>

#include "render/kernel/surface/surface_layers.h"
#include "render/test/scene_builder.h"

namespace gloam {
namespace {

// Two dark boxes side by side under an even sky, both snowed on, the right one of `left`.
Film snowed_boxes(float left, RenderTier tier) {
  SceneBuilder b;
  b.description.sky.ambient = {100, 100, 100};
  b.description.weather.shelter = std::make_shared<const ShelterMap>();
  b.description.weather.snow_start = 0.2f;
  const int dark = b.add_diffuse({0.05f, 0.05f, 0.05f});
  for (const float x : {-0.6f, 0.6f})
    b.add(ShapeType::kBox, {0.5f, 0.5f, 0.5f}, translation({}), dark,
          b.add_body(translation({x, 0, 0})));
  b.frame.snow_left = {1, 1, left};
  RenderSettings settings = settings_of(16, 2);
  settings.tier = tier;
  return b.render(SceneBuilder::camera(look_at({0, -0.01f, 5}, {0, 0, 0}), 64, 32), settings);
}

float mean_of(const Film& film, int from, int to) {
  float sum = 0;
  for (int x = from; x < to; ++x) sum += film.radiance[16 * 64 + static_cast<size_t>(x)].y;
  return sum / static_cast<float>(to - from);
}

TEST(SnowLeft, ABodyThatHasShedItsSnowIsBareInBothTiers) {
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kInteractive}) {
    const Film both = snowed_boxes(1, tier), one = snowed_boxes(0, tier);
    const float white = mean_of(both, 38, 42), bare = mean_of(one, 38, 42);
    EXPECT_GT(white, 5 * bare) << "of the body that shed it";
    EXPECT_NEAR(mean_of(one, 22, 26) / mean_of(both, 22, 26), 1, 0.15) << "the other keeps it";
  }
}

TEST(SnowLeft, CountsForWhatFellAndForAMaterialsOwnSnow) {
  SceneView scene;
  MaterialLayers m;
  m.snow = 0.8f;
  EXPECT_FLOAT_EQ(surfaces::weathered_at(scene, m, 0.25f, {}, {0, 0, 1}).snow, 0.2f);
  scene.fallen.snow = 0.9f;
  EXPECT_FLOAT_EQ(surfaces::weathered_at(scene, m, 1, {}, {0, 0, 1}).snow, 0.9f);
  EXPECT_FLOAT_EQ(surfaces::weathered_at(scene, m, 0, {}, {0, 0, 1}).snow, 0);
}

}  // namespace
}  // namespace gloam

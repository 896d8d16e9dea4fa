// The lux meter against what can be said in closed form.

#include <gtest/gtest.h>

#include "render/test/scene_builder.h"

namespace gloam {
namespace {

TEST(Illuminance, OfALampIsItsIntensityOverTheSquareOfTheDistance) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0, 0, 0}));
  LightDescription lamp;
  lamp.intensity = {500, 500, 500};
  b.add_light(lamp, {0, 0, 3});
  auto renderer = b.make();
  EXPECT_NEAR(renderer->illuminance({0, 0, 1}, {0, 0, 1}), 500.0f / 4, 0.1f);
  const float slant = 5;  // from (4, 0, 0): 3 up, 4 aside
  EXPECT_NEAR(renderer->illuminance({4, 0, 0.001f}, {0, 0, 1}), 500.0f / 25 * 3 / slant, 0.05f);
  EXPECT_NEAR(renderer->illuminance({0, 0, 1}, {0, 0, -1}), 0, 1e-3f) << "from below";
}

TEST(Illuminance, UnderAnEvenSkyIsPiTimesItsLuminance) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0, 0, 0}));
  b.description.sky.ambient = {100, 100, 100};
  auto renderer = b.make();
  EXPECT_NEAR(renderer->illuminance({0, 0, 0.1f}, {0, 0, 1}), 100 * kPi, 0.5f);
  EXPECT_NEAR(renderer->illuminance({0, 0, 0.1f}, {1, 0, 0}), 50 * kPi, 5) << "a wall sees half";
}

TEST(Illuminance, BehindARoofIsWhatTheGroundReflects) {
  SceneBuilder b;
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, b.add_diffuse({0, 0, 0}));
  b.add(ShapeType::kBox, {50, 50, 0.1f}, translation({0, 0, 2}), b.add_diffuse({0, 0, 0}));
  LightDescription lamp;
  lamp.intensity = {500, 500, 500};
  b.add_light(lamp, {0, 0, 4});
  EXPECT_EQ(b.make()->illuminance({0, 0, 1}, {0, 0, 1}), 0) << "light comes through the roof";
}

}  // namespace
}  // namespace gloam

// The guide to what static geometry lets through may change noise alone.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

/// A closed white room, 4 m x 4 m x 3 m, with a square hole of 1 m in the wall at +x; a sky and a
/// sun outside and a lamp inside.
SceneBuilder room_with_window(bool lights_are_static) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.7f, 0.7f, 0.7f});
  const auto wall = [&](Vec3f size, Vec3f p) {
    b.add(ShapeType::kBox, size, translation(p), white);
  };
  wall({2, 2, 0.1f}, {0, 0, -0.1f});
  wall({2, 2, 0.1f}, {0, 0, 3.1f});
  wall({0.1f, 2, 1.7f}, {-2.1f, 0, 1.5f});
  wall({2.2f, 0.1f, 1.7f}, {0, -2.1f, 1.5f});
  wall({2.2f, 0.1f, 1.7f}, {0, 2.1f, 1.5f});
  wall({0.1f, 2, 0.5f}, {2.1f, 0, 0.5f});
  wall({0.1f, 2, 0.5f}, {2.1f, 0, 2.5f});
  wall({0.1f, 0.75f, 0.5f}, {2.1f, -1.25f, 1.5f});
  wall({0.1f, 0.75f, 0.5f}, {2.1f, 1.25f, 1.5f});
  b.add(ShapeType::kSphere, {0.1f, 0.1f, 0.1f}, translation({-1, 0.5f, 2.5f}),
        b.add_emitter({40000, 40000, 40000}));
  LightDescription sun;
  sun.type = LightType::kDirectional;
  sun.intensity = {2000, 2000, 2000};
  sun.radius = 0.01f;
  sun.is_static = lights_are_static;
  b.add_light(sun, {0, 0, 5}, {-0.8f, 0, -0.6f});
  b.description.sky.ambient = {200, 200, 200};
  if (!lights_are_static) {  // nothing static casts light or shadow: no guide
    for (InstanceDescription& instance : b.description.instances) instance.is_static = false;
  }
  return b;
}

TEST(Guide, ChangesTheNoiseAndNotTheMean) {
  RenderSettings settings;
  settings.spp = 1024;
  settings.variance = true;
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 1.5f}, {-1, 1, 0.5f}), 24, 24, 1.2);
  const Mean guided = picture_mean(room_with_window(true).render(view, settings));
  const Mean plain = picture_mean(room_with_window(false).render(view, settings));
  const double error = std::hypot(guided.standard_error(), plain.standard_error());
  EXPECT_NEAR(guided.mean, plain.mean, 4 * error);
  EXPECT_LT(error, 0.01 * plain.mean) << "too noisy to compare";
  // Here the lamp decides and the guide can gain little; it gains where a blocked sun is strong.
  EXPECT_LT(guided.standard_error(), 1.1 * plain.standard_error());
}

}  // namespace
}  // namespace gloam

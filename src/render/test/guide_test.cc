// The guide to what static geometry lets through may change noise alone.

#include <gtest/gtest.h>

#include "render/test/probe.h"

namespace gloam {
namespace {

struct RoomLight {
  const char* name;
  float lamp;  ///< luminance of a sphere of 0.1 m inside [cd/m²]
  float sun;   ///< [lx], most of it blocked
  float sky;   ///< [cd/m²]
};

/// A closed white room, 4 m x 4 m x 3 m, with a square hole of 1 m in the wall at +x; a sky and a
/// sun outside and a lamp inside, where they give light.
SceneBuilder room_with_window(const RoomLight& light, bool is_guided) {
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
  if (light.lamp > 0) {
    b.add(ShapeType::kSphere, {0.1f, 0.1f, 0.1f}, translation({-1, 0.5f, 2.5f}),
          b.add_emitter({light.lamp, light.lamp, light.lamp}));
  }
  if (light.sun > 0) {
    LightDescription sun;
    sun.type = LightType::kDirectional;
    sun.intensity = {light.sun, light.sun, light.sun};
    sun.radius = 0.01f;
    sun.is_static = is_guided;
    b.add_light(sun, {0, 0, 5}, {-0.8f, 0, -0.6f});
  }
  b.description.sky.ambient = {light.sky, light.sky, light.sky};
  if (!is_guided) {  // nothing static casts light or shadow: no guide
    for (InstanceDescription& instance : b.description.instances) instance.is_static = false;
  }
  return b;
}

/// Root mean square over the pixels of their relative standard error; what is darker than a tenth
/// of the mean counts less.
double relative_noise(const Film& film) {
  const double dark = 0.1 * picture_mean(film).mean;
  double sum = 0;
  for (size_t i = 0; i < film.radiance.size(); ++i) {
    sum += film.variance[i].x / (film.radiance[i].x * film.radiance[i].x + dark * dark);
  }
  return std::sqrt(sum / static_cast<double>(film.radiance.size()));
}

struct GuideCase {
  RoomLight light;
  int max_depth;
  double most;  ///< noise with the guide, as a share of that without
};

class GuideTest : public testing::TestWithParam<GuideCase> {};

TEST_P(GuideTest, ChangesTheNoiseAndNotTheMean) {
  RenderSettings settings;
  settings.spp = 128;
  settings.variance = true;
  settings.max_depth = GetParam().max_depth;
  // Sees floor and two walls, but neither the window nor the lamp.
  const CameraView view =
      SceneBuilder::camera(look_at({1.5f, -1.5f, 2.2f}, {-1, 1, 0.4f}), 32, 32, 50);
  const Film guided = room_with_window(GetParam().light, true).render(view, settings);
  const Film plain = room_with_window(GetParam().light, false).render(view, settings);
  const Mean mean = picture_mean(guided), truth = picture_mean(plain);
  const double error = std::hypot(mean.standard_error(), truth.standard_error());
  EXPECT_NEAR(mean.mean, truth.mean, 4 * error);
  EXPECT_LT(error, 0.03 * truth.mean) << "too noisy to compare";
  EXPECT_LT(relative_noise(guided) / relative_noise(plain), GetParam().most);
}

// Deep paths are noisy for reasons that no choice of light mends, so direct light gains more.
INSTANTIATE_TEST_SUITE_P(
    Rooms, GuideTest,
    testing::Values(GuideCase{{"sun_lamp_and_sky", 40000, 2000, 200}, 5, 0.75},
                    GuideCase{{"direct_sun_lamp_and_sky", 40000, 2000, 200}, 2, 0.4},
                    GuideCase{{"sun_and_lamp", 40000, 2000, 0}, 5, 0.75},
                    GuideCase{{"sun_and_weak_lamp", 2000, 2000, 0}, 5, 0.78},
                    GuideCase{{"direct_sun_and_weak_lamp", 2000, 2000, 0}, 2, 0.4},
                    GuideCase{{"sun_and_glow", 200, 2000, 0}, 5, 1.02},
                    GuideCase{{"direct_sun_and_glow", 200, 2000, 0}, 2, 0.6},
                    GuideCase{{"lamp", 40000, 0, 0}, 5, 1.02},
                    GuideCase{{"lamp_and_sky", 40000, 0, 200}, 5, 1.02},
                    GuideCase{{"sky", 0, 0, 200}, 5, 0.7}),
    [](const auto& info) { return std::string(info.param.light.name); });

}  // namespace
}  // namespace gloam

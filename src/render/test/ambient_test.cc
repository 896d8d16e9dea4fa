// The direct tier's ambient light: as bright as the path tier on the whole.

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "render/cpu/path/ambient.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

enum class Place { kOpen, kRoomWithWindow, kRoomWithLamp };

/// A red wall, a white floor and a box on it; all around walls and a ceiling, or nothing.
SceneBuilder make_place(Place place) {
  SceneBuilder b;
  const int white = b.add_diffuse({0.8f, 0.8f, 0.8f}), red = b.add_diffuse({0.7f, 0.1f, 0.1f});
  const auto box = [&b](Vec3f size, Vec3f p, int material) {
    b.add(ShapeType::kBox, size, translation(p), material);
  };
  box({2, 2, 0.1f}, {0, 0, -0.1f}, white);
  box({0.3f, 0.3f, 0.3f}, {0, 0.5f, 0.3f}, white);
  if (place == Place::kOpen) {
    b.description.sky.ambient = {300, 300, 300};
    return b;
  }
  box({0.1f, 2.2f, 1.6f}, {-2.1f, 0, 1.5f}, red);
  box({2, 0.1f, 1.6f}, {0, -2.1f, 1.5f}, white);
  box({2, 0.1f, 1.6f}, {0, 2.1f, 1.5f}, white);
  box({2.2f, 2.2f, 0.1f}, {0, 0, 3.1f}, white);
  if (place == Place::kRoomWithWindow) {  // the upper half of one wall
    box({0.1f, 2.2f, 0.8f}, {2.1f, 0, 0.7f}, white);
    b.description.sky.ambient = {3000, 3000, 3000};
  } else {
    box({0.1f, 2.2f, 1.6f}, {2.1f, 0, 1.5f}, white);
    b.add(ShapeType::kSphere, {0.15f, 0, 0}, translation({0.5f, -0.5f, 2.5f}),
          b.add_emitter({10000, 10000, 10000}));
  }
  return b;
}

CameraView view() {
  return SceneBuilder::camera(look_at({1.7f, -1.7f, 1.8f}, {-0.8f, 0.8f, 0.6f}), 80, 60, 60);
}

double mean_light(const Film& film) {
  double sum = 0;
  for (const Vec3f& c : film.radiance) sum += luminance(c);
  return sum / static_cast<double>(film.radiance.size());
}

class AmbientTest : public testing::TestWithParam<Place> {};

TEST_P(AmbientTest, BringsThePictureToTheBrightnessOfThePathTier) {
  const SceneBuilder b = make_place(GetParam());
  RenderSettings path, direct;
  path.spp = 64;
  direct.spp = 1;
  direct.tier = RenderTier::kDirect;
  const double ratio = mean_light(b.render(view(), direct)) / mean_light(b.render(view(), path));
  EXPECT_NEAR(ratio, 1, 0.12);
}

INSTANTIATE_TEST_SUITE_P(Places, AmbientTest,
                         testing::Values(Place::kOpen, Place::kRoomWithWindow,
                                         Place::kRoomWithLamp));

TEST(Ambient, IsTheSameForAnyNumberOfThreadsAndFrame) {
  const SceneBuilder b = make_place(Place::kRoomWithWindow);
  RenderSettings settings;
  settings.spp = 1;
  settings.tier = RenderTier::kDirect;
  const Film first = b.render(view(), settings);
  settings.frame = 5;
  set_thread_count(3);
  const Film second = b.render(view(), settings);
  set_thread_count(0);
  EXPECT_EQ(first.radiance, second.radiance) << "nothing here is random";
}

TEST(Ambient, ChangesLittleAsTheCameraMoves) {
  const SceneBuilder b = make_place(Place::kRoomWithWindow);  // the renderer refers to it
  const auto renderer = b.make();
  RenderSettings settings;
  settings.spp = 1;
  settings.tier = RenderTier::kDirect;
  double before = 0;
  for (int i = 0; i < 10; ++i) {
    const float angle = 0.01f * static_cast<float>(i);
    const Affine3f X_WC = look_at({1.7f, -1.7f, 1.8f}, {-0.8f + angle, 0.8f + angle, 0.6f});
    Film film;
    renderer->render(SceneBuilder::camera(X_WC, 80, 60, 60), settings, &film);
    const double now = mean_light(film);
    if (i > 0) {
      EXPECT_NEAR(now / before, 1, 0.02) << "step " << i;
    }
    before = now;
  }
}

TEST(Ambient, HasTheHueOfWhatReflectsIt) {
  const SceneBuilder b = make_place(Place::kRoomWithLamp);
  const Probe probe(b);
  CameraView32 camera;
  camera.pose.X_WC_open = view().X_WC_open;
  camera.fx = camera.fy = 50;
  camera.cx = 40;
  camera.cy = 30;
  const AmbientCube ambient = measure_ambient(probe.view, probe.tracer, camera, 80, 60, 5);
  for (const Vec3f n : {Vec3f{0, 0, 1}, Vec3f{0, -1, 0}, Vec3f{1, 0, 0}}) {
    const Vec3f light = ambient.on(n);
    EXPECT_GT(light.y, 10);
    EXPECT_GT(light.x, 1.03f * light.y) << "one wall is red";
  }
}

}  // namespace
}  // namespace gloam

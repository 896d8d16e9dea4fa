// The path stage that cards run is the path stage: the same bits where no media draw numbers.

#include <gtest/gtest.h>

#include "render/kernel/path/path_machine.h"
#include "render/test/media_probe.h"

namespace gloam {
namespace {

SceneBuilder stage(bool rich) {
  SceneBuilder b;
  MaterialDescription m;
  m.base_color = {0.7f, 0.6f, 0.5f};
  m.roughness = 0.3f;
  const int floor = b.add_material(m);
  m.metallic = 1;
  const int metal = b.add_material(m);
  m.metallic = 0;
  if (rich) m.opacity = 0.5f;
  const int sheer = b.add_material(m);
  m.opacity = 1;
  if (rich) m.transmission_weight = 1;
  const int glass = b.add_material(m);
  b.add(ShapeType::kBox, {4, 4, 0.1f}, translation({0, 0, -0.1f}), floor);
  b.add(ShapeType::kBox, {0.1f, 4, 2}, translation({2, 0, 2}), metal);
  b.add(ShapeType::kMesh, {}, translation({0, 0, 0.8f}), glass, 0, b.add_mesh(make_ball(12, 0.1f)));
  b.add(ShapeType::kSphere, {0.5f, 0, 0}, translation({0, 1.4f, 0.5f}), sheer);
  if (rich) {
    b.add(ShapeType::kBox, {0.4f, 0.4f, 0.01f}, translation({0, 0, 3}),
          b.add_emitter({50, 40, 30}));
  }
  LightDescription lamp;
  lamp.intensity = {30, 30, 30};
  lamp.radius = 0.1f;
  b.add_light(lamp, {-1, -1, 2});
  b.description.sky.ambient = {0.5f, 0.6f, 0.7f};
  return b;
}

Ray camera_ray_of(uint32_t i) {
  Sampler sampler = draw(i, 3);
  const Vec2f u = sampler.next_2d();
  return make_ray({-3, -1, 1.5f}, {3, 3 * u.x - 0.5f, 2 * u.y - 1.6f});
}

TEST(PathMachine, MakesThePathsOfTracePath) {
  for (const bool rich : {false, true}) {
    const Probe probe(stage(rich));
    ASSERT_EQ(probe.view.is_plain(), !rich);
    int lit = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
      const Ray ray = camera_ray_of(i);
      const RayCone cone{0, 1e-3f};
      const PathOptions options{6, 3};
      const PathResult a =
          trace_path(probe.view, probe.tracer, ray, cone.width, cone.spread, options, draw(i));
      const PathResult b = run_path(probe.view, probe.tracer, ray, cone, options, draw(i));
      ASSERT_EQ(a.radiance, b.radiance) << i;
      ASSERT_EQ(a.albedo, b.albedo) << i;
      ASSERT_EQ(a.normal, b.normal) << i;
      ASSERT_LE(a.rays, b.rays + 1) << i;
      lit += max_component(a.radiance) > 0;
    }
    EXPECT_GT(lit, 10000);
  }
}

TEST(PathMachine, BringsTheSameLightThroughMedia) {
  SceneBuilder b = stage(true);
  MediaBuilder media;
  media.add_box({6, 6, 3}, {0, 0, 1.5f}, 0.3f,
                media.add_medium({1, 1.2f, 1.4f}, {0.8f, 0.8f, 0.8f}));
  b.description.media = media.media;
  b.description.volumes = media.volumes;
  const Probe probe(b);
  Mean one, other;
  for (uint32_t i = 0; i < 40000; ++i) {
    const Ray ray = camera_ray_of(i);
    const PathOptions options{6, 3};
    one.add(luminance(
        trace_path(probe.view, probe.tracer, ray, 0.0f, 1e-3f, options, draw(i)).radiance));
    other.add(luminance(
        run_path(probe.view, probe.tracer, ray, {0, 1e-3f}, options, draw(i, 2)).radiance));
  }
  const double error = std::hypot(one.standard_error(), other.standard_error());
  EXPECT_NEAR(one.mean, other.mean, 4 * error);
  EXPECT_LT(error, 0.03 * one.mean);
}

}  // namespace
}  // namespace gloam

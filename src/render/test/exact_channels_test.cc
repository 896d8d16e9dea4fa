// The exact channels in lanes: asked for in part, and of points whose way is known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/kernel/camera/channels.h"
#include "render/test/probe.h"

namespace gloam {
namespace {

/// Solids, a mesh, a body that moves, and a pane with holes in front: more than lanes hold alike.
SceneBuilder crowd() {
  SceneBuilder b;
  const int grey = b.add_diffuse({0.5f, 0.5f, 0.5f}), red = b.add_diffuse({0.7f, 0.1f, 0.1f});
  b.add(ShapeType::kPlane, {0, 0, 1}, {}, grey);
  for (int i = 0; i < 24; ++i) {
    const float a = static_cast<float>(i);
    const ShapeType shapes[] = {ShapeType::kBox, ShapeType::kSphere, ShapeType::kCylinder,
                                ShapeType::kEllipsoid};
    b.add(shapes[i % 4], {0.1f, 0.15f, 0.12f},
          rigid({0, 0, 1}, a, {0.35f * (a - 12), std::sin(a), 0.2f}), i % 2 == 0 ? grey : red);
  }
  const int body = b.add_body(translation({0, -1.5f, 0.5f}));
  b.add(ShapeType::kMesh, {}, {}, red, body, b.add_mesh(make_ball(12, 0.2f, 5)));
  MaterialDescription pane;
  pane.opacity = 0.3f;
  b.add(ShapeType::kBox, {0.4f, 0.01f, 0.4f}, translation({1.2f, -2, 0.5f}), b.add_material(pane));
  return b;
}

CameraView view_of_crowd() {
  return SceneBuilder::camera(look_at({0.3f, -4, 2}, {0, 0, 0.2f}), 101, 67, 55);
}

TEST(ExactChannels, PlacesAloneAreTheSameAsWithDetails) {
  const SceneBuilder b = crowd();
  RenderSettings settings;
  settings.spp = 0;
  settings.variance = true;
  const Film whole = b.render(view_of_crowd(), settings);
  settings.exact_details = false;
  const Film places = b.render(view_of_crowd(), settings);
  EXPECT_EQ(places.part, whole.part);
  EXPECT_EQ(places.depth, whole.depth);
  EXPECT_EQ(places.distance, whole.distance);
  EXPECT_TRUE(places.motion.empty() && places.center_normal.empty()) << "nobody asked for them";
  EXPECT_TRUE(places.radiance.empty() && places.variance.empty()) << "no light without samples";
  EXPECT_GT(std::count(whole.part.begin(), whole.part.end(), 26u), 20) << "the mesh is in view";
}

TEST(ExactChannels, LanesTellWhatTheScalarCodeTells) {
  SceneBuilder b = crowd();
  CameraView view = view_of_crowd();
  view.X_WC_previous.p = view.X_WC_open.p + Vec3f{0.05f, 0.02f, -0.01f};
  PoseFrame before = b.frame;
  SceneBuilder::set_body(&before, 1, rigid({0, 1, 0}, 0.4f, {0.2f, -1.4f, 0.45f}));
  const auto renderer = b.make();
  renderer->update(b.frame, b.frame, before);
  RenderSettings settings;
  settings.spp = 0;
  Film film;
  renderer->render(view, settings, &film);

  const Probe probe(b);
  CameraView32 camera;
  camera.fx = static_cast<float>(view.intrinsics.fx);
  camera.fy = static_cast<float>(view.intrinsics.fy);
  camera.cx = static_cast<float>(view.intrinsics.cx);
  camera.cy = static_cast<float>(view.intrinsics.cy);
  camera.pose = {view.X_WC_open, view.X_WC_previous, {}};
  const Affine3f X_WB = rigid({0, 0, 1}, 0, {0, -1.5f, 0.5f});
  const Affine3f X_WB_before = rigid({0, 1, 0}, 0.4f, {0.2f, -1.4f, 0.45f});
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      const size_t i = static_cast<size_t>(y) * film.width + x;
      RayCone cone;
      const Ray ray =
          camera_ray(camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, &cone);
      Surface s;
      RayHit hit;
      uint32_t rays = 0;
      const bool found = find_first(probe.view, probe.tracer, ray, cone, &s, &hit, &rays);
      ASSERT_EQ(film.part[i], found ? s.instance + 1 : 0u) << "at " << x << " " << y;
      Vec2f now, then;
      if (!found) {
        ASSERT_TRUE(project(camera, view.X_WC_open, ray.o + ray.d, &now) &&
                    project(camera, view.X_WC_previous, view.X_WC_previous.p + ray.d, &then));
        EXPECT_FLOAT_EQ(film.motion[i].x, (now - then).x) << "sky at " << x << " " << y;
        continue;
      }
      EXPECT_FLOAT_EQ(film.depth[i], -dot(s.p - view.X_WC_open.p, view.X_WC_open.z));
      EXPECT_FLOAT_EQ(film.center_normal[i].z, s.normal.z);
      EXPECT_FLOAT_EQ(film.center_albedo[i].x, s.base_color.x);
      const bool moves = film.part[i] == 26;
      const Vec3f p_before =
          moves ? transform_point(X_WB_before, transform_point(inverse(X_WB), s.p)) : s.p;
      EXPECT_NEAR(film.scene_flow[i].x, (s.p - p_before).x, 1e-5f) << "at " << x << " " << y;
      EXPECT_NEAR(film.scene_flow[i].z, (s.p - p_before).z, 1e-5f) << "at " << x << " " << y;
      ASSERT_TRUE(project(camera, view.X_WC_open, s.p, &now) &&
                  project(camera, view.X_WC_previous, p_before, &then));
      EXPECT_NEAR(film.motion[i].x, (now - then).x, 2e-3f) << "at " << x << " " << y;
      EXPECT_NEAR(film.motion[i].y, (now - then).y, 2e-3f) << "at " << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace gloam

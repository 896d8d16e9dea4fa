// Panels that shine on one side: the cone that the tree over lights has of them.

#include <gtest/gtest.h>

#include "render/kernel/light/light_tree.h"
#include "render/scene/render_scene.h"
#include "render/test/panel.h"

namespace gloam {
namespace {

/// `count` panels in a row along x, every second turned over, at z = 2.
SceneBuilder row_of_panels(int count, bool outwards) {
  SceneBuilder b;
  const int material = add_panel_material(&b, outwards), mesh = b.add_mesh(make_panel());
  for (int i = 0; i < count; ++i) {
    const Vec3f p{static_cast<float>(i), 0, 2};
    b.add(ShapeType::kMesh, {}, rigid({1, 0, 0}, i % 2 == 0 ? 0 : kPi, p), material, 0, mesh);
  }
  return b;
}

std::unique_ptr<RenderScene> scene_of(const SceneBuilder& b) {
  auto scene = RenderScene::make(b.description);
  GLOAM_CHECK(scene.ok(), "the test's scene is refused");
  const PoseFrame* const key = &b.frame;
  (*scene)->update({&key, 1}, b.frame);
  return std::move(*scene);
}

TEST(PanelCone, TheBackOfAPanelGetsNoDraws) {
  constexpr uint32_t kPanels = 40;
  const SceneBuilder b = row_of_panels(kPanels, true);
  const auto scene = scene_of(b);
  const SceneView view = scene->view_from({});
  ASSERT_EQ(view.lights.size, kPanels);
  ASSERT_GT(view.light_tree.nodes.size, 0u);
  for (const float z : {0.5f, 3.5f}) {
    for (const Vec3f n : {Vec3f{0, 0, z < 2 ? 1.0f : -1.0f}, Vec3f{}}) {
      double sum = 0;
      for (uint32_t i = 0; i < kPanels; ++i) {
        const float share = light_tree::probability(view.light_tree, i, {20, 0, z}, n);
        const bool faces = (i % 2 == 0) == (z < 2);  // even ones shine downwards
        EXPECT_EQ(share > 0, faces) << "panel " << i << " from z = " << z;
        sum += share;
      }
      // Only siblings' shared bounds lose draws.
      double lost = 0;
      for (int k = 0; k < 4000; ++k) {
        const LightChoice c = light_tree::choose(view.light_tree, {20, 0, z}, n, (k + 0.5) / 4000);
        if (!(c.probability > 0)) lost += 1.0 / 4000;
      }
      EXPECT_NEAR(sum + lost, 1, 2e-3);
      EXPECT_LT(lost, 0.01);
    }
  }
}

TEST(PanelCone, PanelsThatShineOnBothSidesAreDrawnFromBoth) {
  const SceneBuilder b = row_of_panels(40, false);
  const auto scene = scene_of(b);
  const SceneView view = scene->view_from({});
  for (const float z : {0.5f, 3.5f}) {
    double sum = 0;
    for (uint32_t i = 0; i < view.lights.size; ++i) {
      const float share = light_tree::probability(view.light_tree, i, {20, 0, z}, {});
      EXPECT_GT(share, 0);
      sum += share;
    }
    EXPECT_NEAR(sum, 1, 1e-4);
  }
}

TEST(PanelCone, IsAsWideAsTheNormalsAre) {
  SceneBuilder b;
  const int material = add_panel_material(&b, true);
  constexpr float kTilt = 0.4f;
  TriangleMesh roof;  // two slopes that face up, and a triangle of no area
  const float rise = std::tan(kTilt);
  roof.positions = {{-1, -1, 0}, {0, -1, rise}, {0, 1, rise}, {-1, 1, 0}, {1, -1, 0}, {1, 1, 0}};
  roof.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2, 0, 0, 1};
  b.add(ShapeType::kMesh, {}, translation({0, 0, 1}), material, 0, b.add_mesh(roof));
  b.add(ShapeType::kMesh, {}, translation({5, 0, 1}), material, 0, b.add_mesh(make_ball(6)));
  const auto scene = scene_of(b);
  const SceneView view = scene->view_from({});
  ASSERT_EQ(view.lights.size, 2u);
  EXPECT_NEAR(view.lights[0].spread, kTilt, 1e-4);
  EXPECT_NEAR(view.lights[0].direction.z, 1, 1e-5);
  EXPECT_EQ(view.lights[1].spread, kPi) << "a closed mesh shines all around";
}

TEST(PanelCone, ATreeOfPanelsLightsAFloorAsTheSumOfThem) {
  const auto light_of = [](int first, int count) {
    SceneBuilder b;
    b.add(ShapeType::kPlane, {}, {}, b.add_diffuse({0.5f, 0.5f, 0.5f}));
    const int mesh = b.add_mesh(make_panel()), on = add_panel_material(&b, true);
    for (int i = first; i < first + count; ++i) {
      const int column = i % 6, row = i / 6;
      const Vec3f p{0.6f * static_cast<float>(column) - 1.5f, 0.6f * static_cast<float>(row) - 1.5f,
                    1};
      const float tilt = 0.3f * static_cast<float>(i % 7) - 0.9f;
      b.add(ShapeType::kMesh, {}, rigid({0, 1, 0}, i % 3 == 0 ? kPi - tilt : tilt, p), on, 0, mesh);
    }
    RenderSettings settings;
    settings.spp = 256;
    settings.max_depth = 2;
    settings.exact_channels = false;
    const Film film =
        b.render(SceneBuilder::camera(look_at({0, -4, 0.6f}, {0, 0, 0}), 24, 16), settings);
    double sum = 0;
    for (int y = 8; y < 16; ++y)
      for (int x = 0; x < 24; ++x) sum += luminance(film.radiance[static_cast<size_t>(24 * y + x)]);
    return sum / (24 * 8);
  };
  double parts = 0;
  for (int i = 0; i < 36; i += 4) parts += light_of(i, 4);
  EXPECT_NEAR(light_of(0, 36) / parts, 1, 0.02);
}

}  // namespace
}  // namespace gloam

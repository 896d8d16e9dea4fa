// Geometry that a camera skips: near planes, back faces, hidden objects; with the CPU's tracers.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "render/test/scene_builder.h"

namespace gloam {
namespace {

// Looks along +x from 5 cm beside the middle of a ball of 10 cm; a wall is at 1.75 m.
struct Housing {
  SceneBuilder b;
  CameraView view;
  uint32_t wall = 0;
};

Housing housing() {
  Housing h;
  h.b.add(ShapeType::kSphere, {0.1f, 0, 0}, {}, h.b.add_diffuse({0.8f, 0.8f, 0.8f}));
  h.b.add(ShapeType::kBox, {0.1f, 9, 9}, translation({1.9f, 0, 0}),
          h.b.add_diffuse({0.5f, 0.5f, 0.5f}));
  h.wall = 2;
  const Affine3f X_WC{{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, {0.05f, 0, 0}};
  h.view = SceneBuilder::camera(X_WC, 16, 12, 1.0);
  return h;
}

void expect_wall(const Housing& h, const char* how) {
  for (const RenderTier tier : {RenderTier::kPath, RenderTier::kDirect, RenderTier::kInteractive}) {
    RenderSettings settings;
    settings.tier = tier;
    settings.spp = 1;
    const Film film = h.b.render(h.view, settings);
    for (size_t i = 0; i < film.depth.size(); ++i) {
      ASSERT_NEAR(film.depth[i], 1.75f, 1e-4f) << how;
      ASSERT_EQ(film.part[i], h.wall) << how;
      ASSERT_GE(film.distance[i], film.depth[i] * 0.9999f) << how;
      if (tier == RenderTier::kInteractive) continue;  // it leaves no albedo
      ASSERT_NEAR(film.albedo[i].x, 0.5f, 0.02f) << how << " tier " << static_cast<int>(tier);
    }
  }
}

TEST(ViewClip, WithoutItAHousingIsAllThatACameraSees) {
  const Housing h = housing();
  const Film film = h.b.render(h.view, {});
  for (const float depth : film.depth) EXPECT_LT(depth, 0.06f);
}

TEST(ViewClip, BackFacesOfItsShellArePassed) {
  Housing h = housing();
  h.view.culls_backs = true;
  expect_wall(h, "back faces");
}

TEST(ViewClip, NothingBeforeTheNearPlaneIsSeen) {
  Housing h = housing();
  h.view.near = 0.2f;
  expect_wall(h, "near");
  h.view.near = 0.01f;
  EXPECT_LT(h.b.render(h.view, {}).depth[0], 0.06f) << "the shell lies beyond it";
}

TEST(ViewClip, HiddenThingsArePassedAndStillCastShadows) {
  Housing h = housing();
  h.view.hidden = std::make_shared<const std::vector<uint8_t>>(std::vector<uint8_t>{1, 0});
  expect_wall(h, "hidden");
}

TEST(ViewClip, FrontsAreSeenAsEver) {
  Housing h = housing();
  h.view.X_WC_open.p = h.view.X_WC_previous.p = {-1, 0, 0};
  const Film before = h.b.render(h.view, {});
  h.view.culls_backs = true;
  h.view.near = 0.05f;
  const Film now = h.b.render(h.view, {});
  EXPECT_EQ(before.part, now.part);
  for (size_t i = 0; i < now.depth.size(); ++i) EXPECT_NEAR(now.depth[i], before.depth[i], 1e-5f);
}

}  // namespace
}  // namespace gloam

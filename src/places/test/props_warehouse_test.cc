// Props of warehouses and streets: what is particular to them.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "places/canvas.h"
#include "places/catalogue.h"

namespace gloam {
namespace {

Prop made(const PropRequest& request, MaterialSet* materials) {
  Result<Prop> prop = make_prop(request, {}, materials);
  EXPECT_TRUE(prop.ok()) << request.kind;
  return prop.ok() ? std::move(prop).value() : Prop();
}

TEST(WarehouseProps, AreSoundForManySeeds) {
  for (const PropFamily family : {goods(), containers(), racks(), trucks(), carts(), safety(),
                                  halls(), stations(), street()}) {
    for (const PropKind& kind : family) {
      for (uint64_t seed = 0; seed < 8; ++seed) {
        SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(seed));
        MaterialSet materials;
        const Prop prop = made({.kind = kind.name, .seed = seed}, &materials);
        const Prop::Box box = prop.bounds();
        const Vec3f size = box.high - box.low;
        EXPECT_GT(prop.mass(), 0);
        const double density = prop.mass() / (double(size.x) * size.y * size.z);
        if (std::string_view(kind.name) != "floor_line") {
          EXPECT_TRUE(density > 5 && density < 3000) << density;
        }
        for (const PropPart& part : prop.parts) {
          std::set<std::string> names;
          EXPECT_GT(part.mass, 0);
          for (const PropVisual& visual : part.visuals) {
            SCOPED_TRACE(visual.name);
            EXPECT_TRUE(names.insert(visual.name).second);
            EXPECT_FALSE(visual.mesh.positions.empty());
            int bad = 0;
            for (const Vec3f n : visual.mesh.normals) bad += !(std::fabs(length(n) - 1) < 1e-3f);
            for (const Vec3f q : visual.mesh.positions) bad += !(std::isfinite(q.x + q.y + q.z));
            EXPECT_EQ(bad, 0);
          }
          EXPECT_TRUE(!part.colliders.empty() || kind.name == std::string_view("floor_line"));
        }
      }
    }
  }
}

TEST(WarehouseProps, StandOnTheFloor) {
  const std::set<std::string> hangs = {"wall_extinguisher", "exit_sign",     "hazard_sign",
                                       "first_aid_box",     "wall_phone",    "hose_reel",
                                       "convex_mirror",     "high_bay_lamp", "strip_lamp",
                                       "air_duct",          "sprinkler_pipe"};
  for (const PropFamily family : {goods(), containers(), racks(), trucks(), carts(), safety(),
                                  halls(), stations(), street()}) {
    for (const PropKind& kind : family) {
      MaterialSet materials;
      const Prop prop = made({.kind = kind.name}, &materials);
      const Prop::Box box = prop.bounds();
      if (hangs.contains(kind.name)) continue;
      EXPECT_NEAR(box.low.z, 0, 2e-3) << kind.name;
    }
  }
}

TEST(WarehouseProps, RackHasALevelForEachBeamAndAPitchOfItsWidth) {
  MaterialSet materials;
  const Prop rack = made({.kind = "pallet_rack", .size = Vec3{1.1, 2.7, 5.35}}, &materials);
  ASSERT_EQ(rack.surfaces.size(), 4u);  // the floor and three shelves
  EXPECT_EQ(rack.surfaces[0].z, 0);
  for (size_t i = 1; i < 4; ++i) {
    EXPECT_GE(rack.surfaces[i].z, 1.7f * float(i) - 1e-4f);
    EXPECT_GT(rack.surfaces[i].clearance, 1.4f);
  }
  // Frames of neighbours coincide: the colliders' outer planes lie 50 mm beyond half the pitch.
  float widest = 0;
  for (const PropCollider& c : rack.body().colliders)
    widest = std::max(widest, float(c.X_PG.p.y) + c.size.y);
  EXPECT_NEAR(widest, 1.35f + 0.05f, 1e-5f);
}

TEST(WarehouseProps, PalletTakesForks) {
  MaterialSet materials;
  const Prop pallet = made({.kind = "pallet"}, &materials);
  EXPECT_NEAR(pallet.bounds().high.z, 0.144f, 1e-6f);
  for (const PropCollider& c : pallet.body().colliders) {
    // Between the runners there are 9 cm of height for forks.
    const bool over_fork = std::fabs(float(c.X_PG.p.y) - 0.2f) < c.size.y;
    if (over_fork) {
      EXPECT_GE(float(c.X_PG.p.z) - c.size.z, 0.09f);
    }
  }
}

TEST(Canvas, FillsByShareOfATexel) {
  Canvas canvas(4, 2, {0, 0, 0});
  canvas.rectangle({0, 0}, {1, 1}, {1, 1, 1}).rectangle({1, 0.5f}, {1.25f, 1}, {1, 0, 0});
  const Image8& image = canvas.image();
  EXPECT_EQ(image.texels[0], 255);            // left half
  EXPECT_EQ(image.texels[3 * 3], 0);          // right end
  EXPECT_NEAR(image.texels[2 * 3], 128, 44);  // the upper texel that is half covered
  EXPECT_EQ(image.texels[2 * 3 + 1], 0);
  EXPECT_EQ(image.texels[3 * (4 + 2)], 0);
}

}  // namespace
}  // namespace gloam

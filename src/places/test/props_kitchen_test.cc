// Kitchens, bathrooms and utility rooms: what a row of units and a wall ask of their props.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "places/catalogue.h"

namespace gloam {
namespace {

Prop made(const std::string& kind, uint64_t seed = 0, std::optional<Vec3> size = {}) {
  MaterialSet materials;
  Result<Prop> prop = make_prop({.kind = kind, .seed = seed, .size = size}, {}, &materials);
  EXPECT_TRUE(prop.ok()) << kind;
  return prop.ok() ? *prop : Prop{};
}

Prop::Box box_of(const PropVisual& visual) {
  Prop one;
  one.body().visuals.push_back(visual);
  return one.bounds();
}

// So that neighbours make one surface.
TEST(KitchenRow, WorktopsEndWhereTheUnitDoes) {
  for (const std::string kind :
       {"kitchen_cabinet", "corner_cabinet", "sink_cabinet", "dishwasher"}) {
    for (uint64_t seed = 0; seed < 5; ++seed) {
      const double width = kind == "corner_cabinet" ? 1.1 : kind == "dishwasher" ? 0.6 : 0.8;
      const Prop prop = made(kind, seed, Vec3{0.60, width, 0.90});
      int worktops = 0;
      for (const PropVisual& visual : prop.body().visuals) {
        if (visual.name != "worktop") continue;
        ++worktops;
        const Prop::Box box = box_of(visual);
        EXPECT_NEAR(box.low.y, -width / 2, 1e-6) << kind;
        EXPECT_NEAR(box.high.y, width / 2, 1e-6) << kind;
        EXPECT_NEAR(box.low.x, -0.30, 1e-6) << kind;
        EXPECT_NEAR(box.high.x, 0.30, 1e-6) << kind;
        EXPECT_NEAR(box.high.z, 0.90, 1e-6) << kind;
        EXPECT_NEAR(box.low.z, 0.862, 1e-6) << kind;
      }
      EXPECT_EQ(worktops, 1) << kind;
      const Prop::Box box = prop.bounds();
      EXPECT_NEAR(box.high.y - box.low.y, width, 1e-5) << kind << " reaches into its neighbour";
      EXPECT_NEAR(box.low.x, -0.30, 1e-5) << kind;
    }
  }
}

// Their fronts stay within the unit's width while they open, and clear of each other.
TEST(KitchenRow, FrontsHaveGaps) {
  for (const std::string kind : {"kitchen_cabinet", "wall_cabinet", "sink_cabinet"}) {
    for (uint64_t seed = 0; seed < 8; ++seed) {
      const Prop prop = made(kind, seed);
      std::vector<Prop::Box> fronts;
      for (const PropPart& part : prop.parts) {
        if (part.parent < 0) continue;
        Prop::Box front{};
        for (const PropVisual& visual : part.visuals)
          if (visual.name == "front") front = box_of(visual);
        const Vec3f at{float(part.p_P.x), float(part.p_P.y), float(part.p_P.z)};
        fronts.push_back({front.low + at, front.high + at});
      }
      ASSERT_FALSE(fronts.empty()) << kind;
      for (size_t i = 0; i < fronts.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
          const float y =
              std::max(fronts[i].low.y - fronts[j].high.y, fronts[j].low.y - fronts[i].high.y);
          const float z =
              std::max(fronts[i].low.z - fronts[j].high.z, fronts[j].low.z - fronts[i].high.z);
          EXPECT_GE(std::max(y, z), 0.0029f) << kind << ' ' << seed;
        }
      }
    }
  }
}

TEST(BathAndKitchen, WallThingsBeginAtTheWall) {
  for (const char* kind : {"wall_cabinet", "range_hood", "towel_rail", "mirror_cabinet",
                           "toilet_paper", "water_heater", "fuse_box"})
    for (uint64_t seed = 0; seed < 5; ++seed)
      EXPECT_NEAR(made(kind, seed).bounds().low.x, 0, 1e-4) << kind << ' ' << seed;
}

TEST(BathAndKitchen, LooseThingsStandOnTheFloor) {
  for (const PropFamily family :
       {kitchen_machines(), kitchenware(), kitchen_stores(), kitchen_seats(), bathroom_things(),
        ironing(), household(), cleaning()}) {
    for (const PropKind& kind : family) {
      for (uint64_t seed = 0; seed < 5; ++seed) {
        const Prop prop = made(kind.name, seed);
        if (!prop.loose) continue;
        Prop colliders;
        colliders.body().colliders = prop.body().colliders;
        EXPECT_NEAR(colliders.bounds().low.z, 0, 1e-6) << kind.name;
        EXPECT_GE(prop.bounds().low.z, -1e-4) << kind.name;
      }
    }
  }
}

// Handles and taps follow the place's style.
TEST(BathAndKitchen, ThingsComeInEveryStyle) {
  for (const char* metal : {"steel", "brass", "black"}) {
    Style style;
    style.metal = metal;
    for (const PropKind& kind : prop_catalogue()) {
      for (uint64_t seed = 0; seed < 3; ++seed) {
        MaterialSet materials;
        const Result<Prop> prop = make_prop({.kind = kind.name, .seed = seed}, style, &materials);
        ASSERT_TRUE(prop.ok()) << kind.name;
        for (const Look& look : materials.looks()) {
          bool shown = false;
          for (const PropPart& part : prop->parts)
            for (const PropVisual& visual : part.visuals) shown |= visual.material == look.name;
          EXPECT_TRUE(shown) << kind.name << " leaves " << look.name;
        }
      }
    }
  }
}

// A bowl that something can be put into.
TEST(BathAndKitchen, BasinsAreHollow) {
  for (const char* kind : {"sink_cabinet", "bathtub", "washbasin"}) {
    const Prop prop = made(kind);
    const float rim = prop.body().visuals.empty()        ? 0
                      : kind == std::string("bathtub")   ? 0.57f
                      : kind == std::string("washbasin") ? 0.85f
                                                         : 0.90f;
    const Vec3f inside{0.04f, kind == std::string("sink_cabinet") ? -0.1f : 0.0f, rim - 0.09f};
    for (const PropCollider& c : prop.body().colliders) {
      if (c.shape != ColliderShape::kBox) continue;
      const Vec3f d = inside - Vec3f{float(c.X_PG.p.x), float(c.X_PG.p.y), float(c.X_PG.p.z)};
      EXPECT_TRUE(std::fabs(d.x) > c.size.x || std::fabs(d.y) > c.size.y ||
                  std::fabs(d.z) > c.size.z)
          << kind;
    }
  }
}

}  // namespace
}  // namespace gloam

// Directions by the light guide: their density, and where it finds light.

#include <gtest/gtest.h>

#include "render/kernel/light/light_directions.h"
#include "render/test/direction_check.h"
#include "render/test/probe.h"
#include "render/test/room_with_window.h"

namespace gloam {
namespace {

/// Two rows; in each some cells are dark, and others very bright.
std::vector<float> make_sums() {
  std::vector<float> sums;
  for (uint32_t row = 0; row < 2; ++row) {
    std::vector<double> light;
    double total = 0;
    for (uint32_t i = 0; i + 1 < LightGuide::kSums; ++i) {
      const double u = static_cast<double>(draw(i, 5 + row).next_1d());
      light.push_back(u < 0.4 ? 0.0 : (u > 0.95 ? 20.0 : u));
      total += light.back();
    }
    double before = 0;
    for (const double l : light) {
      sums.push_back(static_cast<float>(before / total));
      before += l;
    }
    sums.push_back(1);
  }
  return sums;
}

LightGuide guide_of(const std::vector<float>& sums) {
  LightGuide guide;
  guide.arriving = {sums.data(), static_cast<uint32_t>(sums.size())};
  return guide;
}

TEST(LightDirections, FollowTheirDensity) {
  const std::vector<float> sums = make_sums();
  const LightGuide guide = guide_of(sums);
  for (const uint32_t row : {0u, 1u}) {
    check_directions(
        [&](uint32_t i, Vec3f* d) {
          *d = directions::sample<float>(guide, row, random_2d(i, row));
          return true;
        },
        [&](Vec3f d) { return directions::pdf<float>(guide, row, d); }, "guide");
  }
}

TEST(LightDirections, DarkCellsGetNone) {
  const std::vector<float> sums = make_sums();
  const LightGuide guide = guide_of(sums);
  for (uint32_t i = 0; i < 100000; ++i) {
    const Vec3f d = directions::sample<float>(guide, 1u, random_2d(i, 2));
    EXPECT_GT(directions::pdf<float>(guide, 1u, d), 0) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(LightDirections, AreInLanesWhatTheyAreAlone) {
  const std::vector<float> sums = make_sums();
  const LightGuide guide = guide_of(sums);
  for (uint32_t round = 0; round < 500; ++round) {
    Vec2Of<FloatLanes> u;
    UintLanes row;
    for (int i = 0; i < kLaneCount; ++i) {
      set_lane(&u, i, random_2d(round * kLaneCount + static_cast<uint32_t>(i), 3));
      set_lane(&row, i, static_cast<uint32_t>(i) % 2);
    }
    const Vec3Of<FloatLanes> d = directions::sample(guide, row, u);
    const FloatLanes pdf = directions::pdf(guide, row, d);
    for (int i = 0; i < kLaneCount; ++i) {
      const Vec3f one = directions::sample<float>(guide, lane(row, i), lane(u, i));
      EXPECT_EQ(one, lane(d, i));
      EXPECT_EQ(directions::pdf<float>(guide, lane(row, i), one), lane(pdf, i));
    }
  }
}

/// Share of the directions at p, before the normal n, that `is_there` is true of.
template <class Is>
double share_of(const SceneView& view, Vec3f p, Vec3f n, const Is& is_there) {
  const auto row = static_cast<int>(view.guide.row_at(p, n));
  GLOAM_CHECK(row >= 0, "the point lies in no row");
  int found = 0;
  constexpr uint32_t kDraws = 4000;
  for (uint32_t i = 0; i < kDraws; ++i) {
    const Vec3f d =
        directions::sample<float>(view.guide, static_cast<uint32_t>(row), random_2d(i, 4));
    EXPECT_GE(dot(d, n), 0) << "into the wall";
    found += is_there(d) ? 1 : 0;
  }
  return found / static_cast<double>(kDraws);
}

TEST(LightDirections, LeadToTheWindow) {
  Probe probe(room_with_window({"sky", 0, 0, 200}, true));
  probe.guide();
  const auto into_window = [](Vec3f p, float margin) {
    return [=](Vec3f d) {
      if (d.x <= 0) return false;
      const Vec3f at = p + d * ((2 - p.x) / d.x);
      return std::fabs(at.y) < 0.5f + margin && std::fabs(at.z - 1.5f) < 0.5f + margin;
    };
  };
  // It gives about two fifths of the light on them; by the cosine, one direction in nine goes
  // there.
  const Vec3f floor{0.1f, 0.1f, 0}, wall{-2, 0.1f, 1.4f};
  EXPECT_GT(share_of(probe.view, floor, {0, 0, 1}, into_window(floor, 0.3f)), 0.3);
  EXPECT_GT(share_of(probe.view, wall, {1, 0, 0}, into_window(wall, 0.3f)), 0.3);
}

TEST(LightDirections, LeadToWhereTheSunShines) {
  Probe probe(room_with_window({"sun", 0, 2000, 0}, true));
  probe.guide();
  // Light falls through the window by (-0.8, 0, -0.6): on the floor from x = 0.67 down to -0.67.
  const Vec3f ceiling{-1.0f, 0.6f, 3};
  const auto at_patch = [=](Vec3f d) {
    const Vec3f at = ceiling + d * (3 / -d.z);
    return std::fabs(at.x) < 1.0f && std::fabs(at.y) < 0.8f;
  };
  EXPECT_GT(share_of(probe.view, ceiling, {0, 0, -1}, at_patch), 0.4);
}

TEST(LightDirections, AreLeftToTheBsdfInTheOpen) {
  SceneBuilder b;
  const int grey = b.add_diffuse({0.5f, 0.5f, 0.5f});
  b.add(ShapeType::kBox, {4, 4, 0.1f}, translation({0, 0, -0.1f}), grey);
  for (int i = 0; i < 9; ++i) {
    const Vec3f p{static_cast<float>(i % 3) * 1.5f - 1.5f, static_cast<float>(i / 3) * 1.5f, 0.2f};
    b.add(ShapeType::kBox, {0.2f, 0.2f, 0.2f}, translation(p), grey);
  }
  b.description.sky.ambient = {200, 200, 200};
  Probe open(b), room(room_with_window({"sky", 0, 0, 200}, true));
  open.guide();
  room.guide();
  ASSERT_GT(open.view.guide.nx, 0);
  EXPECT_EQ(open.view.guide.probability, 0);
  EXPECT_GT(room.view.guide.probability, 0.5f);
}

}  // namespace
}  // namespace gloam

// What falls from the edges of roofs.

#include "world/weather/roof_drips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kRain = 30e-3 / 3600;  // [m/s]

/// Level ground of 12 x 12 m at z = 0, and over it what `top` says [m].
template <class Top>
ShelterMap map_with(const Top& top) {
  ShelterMap map;
  map.low = {-6, -6};
  map.cell = 0.1f;
  map.nx = map.ny = 120;
  for (int j = 0; j < map.ny; ++j)
    for (int i = 0; i < map.nx; ++i)
      map.height.push_back(top((static_cast<float>(i) + 0.5f) * map.cell - 6,
                               (static_cast<float>(j) + 0.5f) * map.cell - 6));
  return map;
}

/// Of edges over the ground, not of the ground's own.
std::vector<DripEdge> high_edges(const ShelterMap& map) {
  std::vector<DripEdge> edges = find_drip_edges(map, kRain);
  std::erase_if(edges, [](const DripEdge& edge) { return edge.from.z < 0.3f; });
  return edges;
}
double flow_of(const std::vector<DripEdge>& edges) {
  double sum = 0;
  for (const DripEdge& edge : edges) sum += static_cast<double>(edge.flow);
  return sum;
}
bool is_on_roof(float x, float y) { return std::fabs(x) < 2 && std::fabs(y) < 1.5f; }

TEST(RoofDrips, AreAllThatRainsOnARoof) {
  const auto level =
      high_edges(map_with([](float x, float y) { return is_on_roof(x, y) ? 2.5f : 0.0f; }));
  const double rain = kRain * 4 * 3;
  EXPECT_NEAR(flow_of(level), rain, 0.01 * rain);
  // Half of the way from one side to the other runs to each: all sides drip.
  for (const Vec2f side : {Vec2f{1, 0}, Vec2f{-1, 0}, Vec2f{0, 1}, Vec2f{0, -1}}) {
    double here = 0;
    for (const DripEdge& edge : level)
      if (edge.out.x == side.x && edge.out.y == side.y) here += static_cast<double>(edge.flow);
    EXPECT_GT(here, 0.15 * rain) << side.x << ", " << side.y;
  }
  // A gable: the ridge along x, the eaves at y = +-1.5 m.
  const auto gable = high_edges(map_with(
      [](float x, float y) { return is_on_roof(x, y) ? 3.5f - 0.5f * std::fabs(y) : 0.0f; }));
  EXPECT_NEAR(flow_of(gable), rain, 0.01 * rain);
  double eaves = 0;
  for (const DripEdge& edge : gable)
    if (edge.out.y != 0) eaves += static_cast<double>(edge.flow);
  EXPECT_NEAR(eaves, rain, 0.1 * rain) << "all but what falls on the verges' own cells";
}

TEST(RoofDrips, AreNoneOfStepsAndBanks) {
  EXPECT_TRUE(high_edges(map_with([](float x, float) { return 0.5f * x + 4; })).size() <= 480)
      << "of the map's own border alone";
  EXPECT_EQ(flow_of(high_edges(map_with([](float x, float) { return x > 0 ? 0.25f : 0.0f; }))), 0);
}

TEST(RoofDrips, FallAsMuchAsRunsThereAndTheSameWheneverTheyAreLookedAt) {
  const auto edges =
      high_edges(map_with([](float x, float y) { return is_on_roof(x, y) ? 2.5f : 0.0f; }));
  double water = 0;
  constexpr double kSeconds = 20;
  std::vector<Drip> parts, all;
  for (const DripEdge& edge : edges) {
    const size_t before = all.size();
    find_drips(edge, 7, 100, 100 + kSeconds, &all);
    for (size_t i = before; i < all.size(); ++i) {
      const auto d = static_cast<double>(all[i].diameter);
      EXPECT_GE(d, 4e-3 - 1e-9);
      EXPECT_LE(d, 5e-3 + 1e-9);
      EXPECT_LT(std::fabs(all[i].along), 0.5f);
      water += M_PI / 6 * d * d * d;
    }
    find_drips(edge, 7, 100, 108.3, &parts);
    find_drips(edge, 7, 108.3, 100 + kSeconds, &parts);
  }
  // Some 40,000 drops.
  EXPECT_NEAR(water, flow_of(edges) * kSeconds, 0.02 * water);
  ASSERT_EQ(parts.size(), all.size());
  const auto time = [](const Drip& a, const Drip& b) { return a.time < b.time; };
  std::sort(all.begin(), all.end(), time);
  std::sort(parts.begin(), parts.end(), time);
  for (size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i].time, parts[i].time);
}

TEST(RoofDrips, FallFreelyAtFirstAndNoFasterThanRainInTheEnd) {
  const DripFall fall(4.5e-3f);
  EXPECT_NEAR(fall.depth(0.1), 9.81 * 0.01 / 2, 0.001);
  EXPECT_NEAR(fall.speed(0.1), 0.981, 0.01);
  EXPECT_NEAR(fall.speed(10), 8.96, 0.05);
  for (const double depth : {0.05, 0.75, 2.5, 20.0}) {
    EXPECT_NEAR(fall.depth(fall.time(depth)), depth, 1e-6 * depth);
    const double t = fall.time(depth), step = 1e-5;
    EXPECT_NEAR((fall.depth(t + step) - fall.depth(t - step)) / (2 * step), fall.speed(t), 1e-4);
  }
}

}  // namespace
}  // namespace gloam

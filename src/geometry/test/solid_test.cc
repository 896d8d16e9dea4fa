// Solids made by formula: closed, facing outwards, of the volume that geometry books say.

#include "geometry/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

namespace gloam {
namespace {

// By the divergence theorem; right only when the surface is closed and faces outwards.
double volume(const Solid& solid) {
  const TriangleMesh& m = solid.mesh();
  double sum = 0;
  for (size_t f = 0; f + 2 < m.indices.size(); f += 3) {
    const Vec3f a = m.positions[m.indices[f]], b = m.positions[m.indices[f + 1]],
                c = m.positions[m.indices[f + 2]];
    sum += dot(a, cross(b, c)) / 6;
  }
  return sum;
}

// Edges that are not met by their opposite at the same place.
int open_edges(const Solid& solid) {
  using Point = std::tuple<int, int, int>;
  const TriangleMesh& m = solid.mesh();
  const auto at = [&](uint32_t i) {
    const Vec3f p = m.positions[i] * 1e5f;
    return Point{std::lround(p.x), std::lround(p.y), std::lround(p.z)};
  };
  std::map<std::pair<Point, Point>, int> edges;
  for (size_t f = 0; f + 2 < m.indices.size(); f += 3) {
    for (int k = 0; k < 3; ++k) {
      const Point a = at(m.indices[f + static_cast<size_t>(k)]),
                  b = at(m.indices[f + static_cast<size_t>((k + 1) % 3)]);
      if (a == b) continue;
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  }
  int open = 0;
  for (const auto& [edge, count] : edges) open += count > 0;
  return open;
}

void expect_sound(const Solid& solid, double wanted, double tolerance, const char* what) {
  SCOPED_TRACE(what);
  EXPECT_NEAR(volume(solid), wanted, tolerance * wanted);
  EXPECT_EQ(open_edges(solid), 0);
  const TriangleMesh& m = solid.mesh();
  ASSERT_EQ(m.normals.size(), m.positions.size());
  for (const Vec3f& n : m.normals) EXPECT_NEAR(length(n), 1, 1e-4);
  for (const uint32_t i : m.indices) EXPECT_LT(i, m.positions.size());
}

TEST(Solid, BoxesHaveTheirVolume) {
  expect_sound(rounded_box({1, 2, 3}, 0), 6, 1e-5, "sharp");
  // Edges and corners rounded by r leave V = abc with r³(4π/3 - 8) + r²(π - 4)(a' + b' + c').
  const double r = 0.2, edges = (1 - 2 * r) + (2 - 2 * r) + (3 - 2 * r);
  const double wanted = 6 + r * r * r * (4 * M_PI / 3 - 8) + r * r * (M_PI - 4) * edges;
  expect_sound(rounded_box({1, 2, 3}, 0.2f, 8), wanted, 2e-3, "rounded");
  expect_sound(slab({-1, 0, 2}, {1, 3, 4}, 0.001f), 12, 1e-4, "slab");
  EXPECT_EQ(slab({-1, 0, 2}, {1, 3, 4}).low().z, 2);
  EXPECT_EQ(slab({-1, 0, 2}, {1, 3, 4}).high().y, 3);
}

TEST(Solid, TurnedProfilesHaveTheirVolume) {
  const double share = 48 / (2 * M_PI) * std::sin(2 * M_PI / 48);  // of a polygon in its circle
  expect_sound(cylinder(0.5f, 0, 2, 0, 48), M_PI * 0.25 * 2 * share, 1e-3, "cylinder");
  expect_sound(cone(0.5f, 0.25f, 0, 1, 0, 48), M_PI / 3 * (0.25 + 0.125 + 0.0625) * share, 1e-3,
               "cone");
  expect_sound(ball(0.5f, 96), M_PI / 6, 5e-3, "ball");
  expect_sound(bar({0, 0, 0}, {1, 1, 1}, 0.1f, 0.1f, 48), M_PI * 0.01 * std::sqrt(3) * share, 2e-2,
               "bar");
}

TEST(Solid, ExtrusionsMayBeConcave) {
  expect_sound(extrude({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, -1, 1), 6, 1e-5, "L");
  expect_sound(extrude(circle(1, 64), 0, 1), M_PI * 64 / (2 * M_PI) * std::sin(2 * M_PI / 64), 1e-4,
               "round");
  expect_sound(extrude(rounded_rectangle(2, 1, 0.1f, 8), 0, 3), 3 * (2 - (4 - M_PI) * 0.01), 1e-3,
               "rounded");
}

TEST(Solid, TubesAndSheetsAreClosed) {
  expect_sound(tube({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, 0.1f, 48),
               M_PI * 0.01 * 2 * 48 / (2 * M_PI) * std::sin(2 * M_PI / 48), 1e-3, "tube");
  const Vec3f corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  expect_sound(sheet(corners, 2, 0.1f), 0.1, 1e-4, "sheet");
  EXPECT_EQ(open_edges(cushion({0.5f, 0.5f, 0.2f}, 0.3f, 0.05f, 7)), 0);
  EXPECT_GT(volume(cushion({0.5f, 0.5f, 0.2f}, 0.3f, 0.05f, 7)), 0.5 * 0.5 * 0.2 * 0.8);
}

TEST(Solid, MovesTurnsAndMirrorsWithoutTurningInsideOut) {
  const Solid box = slab({0, 0, 0}, {1, 2, 3}, 0);
  const Solid turned = box.turned(Axis::kZ, 90);
  EXPECT_NEAR(turned.low().x, -2, 1e-5);
  EXPECT_NEAR(turned.high().y, 1, 1e-5);
  expect_sound(box.mirrored(Axis::kX), 6, 1e-5, "mirrored");
  expect_sound(box.scaled({2, 1, 0.5f}), 6, 1e-5, "scaled");
  expect_sound(box + box.moved(5, 0, 0), 12, 1e-5, "two");
}

TEST(Solid, PanelsReadUprightFromTheirFront) {
  const TriangleMesh m = panel(2, 1).mesh();
  for (size_t i = 0; i < m.positions.size(); ++i) {
    EXPECT_EQ(m.normals[i].x, 1);
    EXPECT_NEAR(m.uvs[i].x, m.positions[i].y / 2 + 0.5f, 1e-6);
    EXPECT_NEAR(m.uvs[i].y, m.positions[i].z + 0.5f, 1e-6);
  }
}

}  // namespace
}  // namespace gloam

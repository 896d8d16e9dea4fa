// Sampling of ground from triangles: closed forms, no gaps, layers, fields.

#include "geometry/height_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "geometry/height_field_parts.h"

namespace gloam {
namespace {

/// n x n quads over [0, size]².
template <class Height>
TriangleMesh terrain(int n, double size, Height&& height) {
  TriangleMesh mesh;
  for (int r = 0; r <= n; ++r) {
    for (int c = 0; c <= n; ++c) {
      const double x = size * c / n, y = size * r / n;
      mesh.positions.push_back(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(height(x, y))});
    }
  }
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      const auto i = static_cast<uint32_t>(r * (n + 1) + c), w = static_cast<uint32_t>(n + 1);
      for (const uint32_t k : {i, i + 1, i + w, i + 1, i + w + 1, i + w}) mesh.indices.push_back(k);
    }
  }
  return mesh;
}

/// Closed box.
void add_box(Vec3f low, Vec3f high, TriangleMesh* mesh) {
  const auto first = static_cast<uint32_t>(mesh->positions.size());
  for (int k = 0; k < 8; ++k)
    mesh->positions.push_back(
        {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  for (const uint32_t i : {4, 5, 6, 5, 7, 6, 0, 2, 1, 1, 2, 3, 0, 1, 4, 1, 5, 4,
                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
    mesh->indices.push_back(first + i);
}

AffineOf<double> turned(double angle, Vec3Of<double> p) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}, p};
}

Floors sample(const PlacedMesh& mesh, const HeightGrid& grid, int layers = 1) {
  Result<Floors> floors = sample_floors({&mesh, 1}, grid, layers);
  EXPECT_TRUE(floors.ok()) << floors.error().to_string();
  return std::move(floors).value();
}

HeightGrid grid_over(double low, double high, double resolution) {
  return make_height_grid({low, low}, {high, high}, resolution, 1).value();
}

TEST(HeightGrid, EndsWhereTheRegionEnds) {
  const HeightGrid grid = make_height_grid({-1, 2}, {19, 2.95}, 0.1, 1).value();
  EXPECT_EQ(grid.columns, 201);
  EXPECT_EQ(grid.rows, 11);
  EXPECT_DOUBLE_EQ(grid.step[1] * 10, 0.95);
}

TEST(HeightGrid, RefusesWhatIsEmptyOrTooLarge) {
  const auto complaint = [](std::array<double, 2> low, std::array<double, 2> high, double step) {
    return make_height_grid(low, high, step, 2).error().to_string();
  };
  EXPECT_EQ(complaint({0, 1}, {1, 1}, 0.1), "the region is empty: y from 1 to 1 m");
  EXPECT_EQ(complaint({0, NAN}, {1, 1}, 0.1), "the region is empty: y from nan to 1 m");
  EXPECT_NE(complaint({0, 0}, {1e9, 1e9}, 1e-4).find("exceed the limit of 16777216"),
            std::string::npos);
}

TEST(SampleFloors, OfAPlaneAreExact) {
  const TriangleMesh mesh = terrain(7, 10, [](double x, double y) { return 0.5 * x - 0.25 * y; });
  const double angle = 0.3;
  const PlacedMesh placed{&mesh, turned(angle, {100, -50, 3})};
  const HeightGrid grid = make_height_grid({100.5, -46.5}, {104, -43}, 0.07, 1).value();
  const Floors floors = sample(placed, grid);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c) {
      const double x = grid.low[0] + c * grid.step[0] - 100,
                   y = grid.low[1] + r * grid.step[1] + 50;
      const double mx = std::cos(angle) * x + std::sin(angle) * y;
      const double my = -std::sin(angle) * x + std::cos(angle) * y;
      const auto i = static_cast<size_t>(r * grid.columns + c);
      ASSERT_NEAR(floors.at(0, i), 3 + 0.5 * mx - 0.25 * my, 2e-6) << c << ' ' << r;
    }
  }
}

// Samples on vertices, on edges, and anywhere; triangles larger and smaller than cells.
TEST(SampleFloors, LeaveNoGapsBetweenTriangles) {
  for (const int n : {1, 10, 64, 777}) {
    const TriangleMesh mesh = terrain(n, 10, [](double x, double y) { return std::sin(x + y); });
    for (const double angle : {0.0, 0.1, kPi / 4.0, 1.0}) {
      const PlacedMesh placed{&mesh,
                              turned(angle, {-std::cos(angle) * 5 + std::sin(angle) * 5,
                                             -std::sin(angle) * 5 - std::cos(angle) * 5, 0})};
      const Floors floors = sample(placed, grid_over(-3.5, 3.5, 7.0 / 640));
      EXPECT_EQ(std::count_if(floors.z.begin(), floors.z.end(), [](float z) { return !(z < 2); }),
                0)
          << n << " quads, turned by " << angle;
    }
    const Floors whole = sample({&mesh, {}}, grid_over(0, 10, 0.1));  // borders included
    EXPECT_EQ(std::count_if(whole.z.begin(), whole.z.end(), [](float z) { return !(z < 2); }), 0);
  }
}

TEST(SampleFloors, AreTheSameForAnyNumberOfThreadsAndOrderOfTriangles) {
  TriangleMesh mesh = terrain(90, 10, [](double x, double y) { return std::cos(3 * x) * y; });
  add_box({2, 2, 12}, {6, 7, 13}, &mesh);
  const HeightGrid grid = grid_over(0, 10, 0.031);
  const Floors many = sample({&mesh, turned(0.2, {})}, grid, 3);
  set_thread_count(1);
  TriangleMesh reversed = mesh;
  for (size_t i = 0, j = mesh.indices.size() - 3; i < mesh.indices.size(); i += 3, j -= 3)
    std::copy_n(&mesh.indices[i], 3, &reversed.indices[j]);
  const Floors one = sample({&reversed, turned(0.2, {})}, grid, 3);
  set_thread_count(0);
  EXPECT_EQ(0, std::memcmp(many.z.data(), one.z.data(), many.z.size() * sizeof(float)));
}

TEST(SampleFloors, AreWhatFacesUpAndHasAirOverIt) {
  TriangleMesh mesh;
  add_box({0, 0, -0.5f}, {10, 10, 0}, &mesh);  // ground
  add_box({2, 2, 2.8f}, {8, 8, 3}, &mesh);     // a roof of 20 cm
  add_box({4, 4, 0.2f}, {5, 5, 2.7f}, &mesh);  // a block: 10 cm under the roof, 20 cm over ground
  const Floors floors = sample({&mesh, {}}, grid_over(0.05, 9.95, 0.1), 4);
  const auto column = [&](double x, double y) {
    const auto at =
        static_cast<size_t>(std::lround((y - 0.05) / 0.1) * 100 + std::lround((x - 0.05) / 0.1));
    std::vector<float> z;
    for (int layer = 0; layer < 4 && !std::isnan(floors.at(layer, at)); ++layer)
      z.push_back(floors.at(layer, at));
    return z;
  };
  EXPECT_EQ(column(1.05, 5.05), std::vector<float>({0}));
  EXPECT_EQ(column(3.05, 3.05), std::vector<float>({3, 0}));
  EXPECT_EQ(column(4.55, 4.55), std::vector<float>({3}));
}

TEST(SampleFloors, RefuseWhatWouldTakeForever) {
  TriangleMesh mesh;
  for (int i = 0; i < 100; ++i) add_box({-9, -9, -1}, {9, 9, 1}, &mesh);
  const PlacedMesh placed{&mesh, {}};
  const HeightGrid grid = grid_over(-5, 5, 0.1);
  EXPECT_TRUE(sample_floors({&placed, 1}, grid, 1).ok());
  EXPECT_EQ(sample_floors({&placed, 1}, grid, 2).error().message,
            "more than 64 surfaces lie above one another");
  for (int i = 0; i < 3000; ++i) add_box({-9, -9, -1}, {9, 9, 1}, &mesh);
  EXPECT_EQ(sample_floors({&placed, 1}, grid, 1).error().message,
            "more than 1024 surfaces lie above one another");
}

TEST(SampleFloors, OfAMirroredMeshFaceTheSameWay) {
  TriangleMesh mesh;
  add_box({0, 0, -0.5f}, {10, 10, 0}, &mesh);
  add_box({2, 2, 2.8f}, {8, 8, 3}, &mesh);
  AffineOf<double> mirror;
  mirror.x = {-1, 0, 0};
  const Floors floors =
      sample({&mesh, mirror}, make_height_grid({-5.5, 4.5}, {-4.5, 5.5}, 0.5, 2).value(), 2);
  EXPECT_EQ(floors.at(0, 4), 3);
  EXPECT_EQ(floors.at(1, 4), 0);
}

TEST(GroundOf, FillsFromTheLowestNeighbourRingByRing) {
  Floors floors{{{0, 0}, {1, 1}, 5, 1}, 1, {4, NAN, NAN, NAN, 2}};
  const HeightField field = ground_of(floors).value();
  EXPECT_EQ(field.z, std::vector<float>({4, 4, 2, 2, 2}));
  EXPECT_EQ(field.filled, 3);
  floors.z.assign(5, NAN);
  EXPECT_EQ(ground_of(floors).error().message, "no sample of the region has a surface below it");
}

TEST(SampleFloors, MeetNothingOfVerticalWalls) {
  TriangleMesh wall;
  wall.positions = {{1.5f, 0, 0}, {1.5f, 3, 0}, {1.5f, 0, 2}};
  wall.indices = {0, 1, 2};
  EXPECT_FALSE(ground_of(sample({&wall, {}}, grid_over(0, 4, 1))).ok());
}

TEST(SlabsOf, AFloorWithAHoleAreRectanglesWithoutIt) {
  TriangleMesh mesh;
  add_box({0, 0, -0.5f}, {10, 10, 0}, &mesh);
  // A floor at 3 m with a hole of 4 x 2 m, in four boxes that touch.
  add_box({0, 0, 2.8f}, {3, 10, 3}, &mesh);
  add_box({7, 0, 2.8f}, {10, 10, 3}, &mesh);
  add_box({3, 0, 2.8f}, {7, 4, 3}, &mesh);
  add_box({3, 6, 2.8f}, {7, 10, 3}, &mesh);
  const Floors floors = sample({&mesh, {}}, grid_over(0.05, 9.95, 0.1), 2);
  const HeightField ground = ground_of(floors).value();
  EXPECT_EQ(*std::max_element(ground.z.begin(), ground.z.end()), 0);
  const std::vector<HeightField> slabs = slabs_of(floors).value();
  EXPECT_EQ(slabs.size(), 4u);
  std::vector<int> cover(99 * 99);
  for (const HeightField& slab : slabs) {
    for (const float z : slab.z) EXPECT_EQ(z, 3);
    for (int r = 0; r + 1 < slab.grid.rows; ++r)
      for (int c = 0; c + 1 < slab.grid.columns; ++c)
        ++cover[static_cast<size_t>((slab.row + r) * 99 + slab.column + c)];
  }
  for (int r = 0; r < 99; ++r) {
    for (int c = 0; c < 99; ++c) {
      const bool is_hole = c >= 29 && c < 70 && r >= 39 && r < 60;
      EXPECT_EQ(cover[static_cast<size_t>(r * 99 + c)], is_hole ? 0 : 1) << c << ' ' << r;
    }
  }
}

// A table below the upper floor neither tears that floor nor is part of it.
TEST(SlabsOf, FloorsAreFollowedByHeightNotByNumber) {
  TriangleMesh mesh;
  add_box({0, 0, -0.5f}, {10, 10, 0}, &mesh);
  add_box({0, 0, 2.8f}, {10, 10, 3}, &mesh);
  add_box({4, 4, 0.7f}, {5, 6, 0.8f}, &mesh);
  const std::vector<HeightField> slabs =
      slabs_of(sample({&mesh, {}}, grid_over(0.05, 9.95, 0.1), 3)).value();
  ASSERT_EQ(slabs.size(), 2u);
  EXPECT_EQ(slabs[0].grid.size(), 100u * 100u);
  EXPECT_EQ(slabs[1].grid.size(), 10u * 20u);
  EXPECT_FLOAT_EQ(slabs[1].z[0], 0.8f);
}

TEST(SlabsOf, ASlopeOverAFloorLeavesItsAir) {
  TriangleMesh mesh;
  add_box({0, 0, -0.5f}, {10, 10, 0}, &mesh);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3f p : {Vec3f{2, 2, 0}, Vec3f{8, 2, 3}, Vec3f{8, 4, 3}, Vec3f{2, 4, 0}})
    mesh.positions.push_back(p);
  for (const uint32_t i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(first + i);
  const Floors floors = sample({&mesh, {}}, grid_over(0.05, 9.95, 0.1), 2);
  const std::vector<HeightField> slabs = slabs_of(floors).value();
  EXPECT_GT(slabs.size(), 10u);
  EXPECT_LT(slabs.size(), 30u);
  for (const HeightField& slab : slabs) {
    const auto [low, high] = std::minmax_element(slab.z.begin(), slab.z.end());
    EXPECT_LE(*high - *low, kMostLostAir + 1e-6);
  }
}

TEST(HeightErrorOf, APlaneIsNothingAndOfASteepStepIsSeen) {
  const TriangleMesh plane = terrain(3, 10, [](double x, double y) { return 0.3 * x + 0.2 * y; });
  const auto error_of = [](const TriangleMesh& mesh, double step) {
    const PlacedMesh placed{&mesh, {}};
    const Floors floors = sample(placed, grid_over(0.5, 9.5, step));
    const HeightField ground = ground_of(floors).value();
    return height_error({&placed, 1}, floors, {&ground, 1}).value();
  };
  const HeightError none = error_of(plane, 0.3);
  EXPECT_EQ(none.points, 900);
  EXPECT_LT(none.most, 2e-6);
  // Of a parabola z = x², sampled at steps h, linear interpolation errs by u (1 - u) h²: h² / 6 on
  // average and h² / 4 at most.
  const TriangleMesh bowl = terrain(2000, 10, [](double x, double) { return x * x; });
  const HeightError bent = error_of(bowl, 0.5);
  EXPECT_NEAR(bent.mean, 0.25 / 6, 0.25 / 6 * 0.15);
  EXPECT_NEAR(bent.most, 0.25 / 4, 0.25 / 4 * 0.02);
  EXPECT_GT(bent.p95, bent.mean);
  EXPECT_LE(bent.p95, bent.most);
}

TEST(HeightErrorOf, WhatMetNothingIsNotInIt) {
  // A plane that climbs, under a tenth of the region: what is filled in beside it is level.
  const TriangleMesh plane = terrain(30, 3, [](double x, double) { return 2 * x; });
  const PlacedMesh placed{&plane, {}};
  const Floors floors = sample(placed, grid_over(0.05, 9.95, 0.1));
  const HeightField ground = ground_of(floors).value();
  EXPECT_GT(ground.filled, static_cast<int64_t>(ground.grid.size()) / 2);
  const HeightError error = height_error({&placed, 1}, floors, {&ground, 1}).value();
  EXPECT_GT(error.points, 700);
  EXPECT_LT(error.points, 900);
  EXPECT_LT(error.most, 1e-5);
}

}  // namespace
}  // namespace gloam

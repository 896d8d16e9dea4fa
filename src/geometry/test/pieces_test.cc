// Meshes of several pieces: those that are convex need no search.

#include "geometry/convert/pieces.h"

#include <gtest/gtest.h>

#include "geometry/convert/convert.h"
#include "geometry/convert/hull.h"
#include "geometry/convert/mass.h"

namespace gloam {
namespace {

void append_box(Vec3f at, Vec3f half, TriangleMesh* mesh, bool inwards = false) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({at.x + (i & 1 ? half.x : -half.x), at.y + (i & 2 ? half.y : -half.y),
                       at.z + (i & 4 ? half.z : -half.z)});
  const TriangleMesh box = convex_hull(corners);
  const auto first = static_cast<uint32_t>(mesh->positions.size());
  mesh->positions.insert(mesh->positions.end(), box.positions.begin(), box.positions.end());
  for (size_t t = 0; t + 2 < box.indices.size(); t += 3)
    for (const size_t k : {t, inwards ? t + 2 : t + 1, inwards ? t + 1 : t + 2})
      mesh->indices.push_back(first + box.indices[k]);
}

double volume_of(const std::vector<TriangleMesh>& hulls) {
  double sum = 0;
  for (const TriangleMesh& hull : hulls) sum += mass_properties(hull).volume;
  return sum;
}

TEST(MeshPieces, OfBoxesAreTheBoxes) {
  TriangleMesh mesh;
  for (int i = 0; i < 5; ++i)
    append_box({0.3f * static_cast<float>(i), 0, 0}, {.2f, .1f, .1f}, &mesh);
  const Pieces pieces = pieces_of(mesh, 0.05);
  EXPECT_EQ(pieces.convex.size(), 5u);
  EXPECT_TRUE(pieces.closed.empty());
  EXPECT_TRUE(pieces.open.indices.empty());
}

TEST(MeshPieces, WithAHollowStayWhole) {
  TriangleMesh mesh;
  append_box({0, 0, 0}, {1, 1, 1}, &mesh);
  append_box({0, 0, 0}, {.8f, .8f, .8f}, &mesh, true);
  const Pieces pieces = pieces_of(mesh, 0.05);
  EXPECT_TRUE(pieces.convex.empty());
  ASSERT_EQ(pieces.closed.size(), 1u);
  EXPECT_EQ(pieces.closed[0].indices, mesh.indices);
}

TEST(MeshPieces, ThatAreOpenAreKeptTogether) {
  TriangleMesh mesh;
  append_box({0, 0, 0}, {1, 1, 1}, &mesh);
  for (const float x : {3.0f, 6.0f}) {
    append_box({x, 0, 0}, {1, 1, 1}, &mesh);
    mesh.indices.resize(mesh.indices.size() - 3);
  }
  const Pieces pieces = pieces_of(mesh, 0.05);
  EXPECT_EQ(pieces.convex.size(), 1u);
  EXPECT_EQ(pieces.open.triangle_count(), 22u);
}

TEST(MeshPieces, AreMergedWhereThatEnclosesLeast) {
  TriangleMesh mesh;
  for (const float x : {0.0f, 1.0f, 5.0f, 6.0f, 20.0f})
    append_box({x, 0, 0}, {.5f, .5f, .5f}, &mesh);
  const auto merged = merge_hulls(pieces_of(mesh, 0.05).convex, 3);
  ASSERT_EQ(merged.size(), 3u);
  EXPECT_NEAR(volume_of(merged), 5, 1e-4) << "neighbours with a common face";
  EXPECT_EQ(merge_hulls(merged, 1).size(), 1u);
}

// 48 boxes that cross each other: CoACD alone takes minutes.
TEST(MeshPieces, ThatCrossEachOtherAreConvertedAtOnce) {
  TriangleMesh mesh;
  uint32_t state = 7;
  const auto draw = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / static_cast<float>(1 << 24);
  };
  for (int i = 0; i < 48; ++i) {
    const Vec3f at{2 * draw() - 1, 2 * draw() - 1, 2 * draw() - 1};
    append_box(at, {.05f + .3f * draw(), .05f + .3f * draw(), .05f + .3f * draw()}, &mesh);
  }
  ASSERT_EQ(mesh.triangle_count(), 576u);
  const auto converted = convert_mesh(mesh, {.colliders = "hulls"});
  ASSERT_TRUE(converted.ok()) << converted.error().to_string();
  EXPECT_EQ(converted->colliders.size(), 32u);
}

}  // namespace
}  // namespace gloam

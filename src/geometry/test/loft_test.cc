#include <gtest/gtest.h>

#include <cmath>

#include "geometry/solid.h"

namespace gloam {
namespace {

Path level_circle(float radius, float z) {
  Path out;
  for (const Vec2f p : circle(radius, 64)) out.push_back({p.x, p.y, z});
  return out;
}

double volume_of(const TriangleMesh& mesh) {
  double volume = 0;
  for (size_t f = 0; f < mesh.indices.size(); f += 3) {
    const Vec3f a = mesh.positions[mesh.indices[f]], b = mesh.positions[mesh.indices[f + 1]],
                c = mesh.positions[mesh.indices[f + 2]];
    volume += double(dot(a, cross(b, c))) / 6;
  }
  return volume;
}

TEST(Loft, EnclosesAConeThatFacesOutwards) {
  const Path low = level_circle(0.5f, 0), center(64, Vec3f{0, 0, 0}), tip(64, Vec3f{0, 0, 0.6f});
  const Solid cone = loft({center, low, low, tip});
  EXPECT_NEAR(volume_of(cone.mesh()), kPi * 0.25 * 0.6 / 3, 0.002);
  const TriangleMesh& mesh = cone.mesh();
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
  for (const Vec3f n : mesh.normals) EXPECT_NEAR(dot(n, n), 1, 1e-5);
  // The bottom's rim faces down, the mantle's at the same place outwards and up.
  EXPECT_NEAR(mesh.normals[64].z, -1, 1e-5);
  EXPECT_GT(mesh.normals[128].x, 0.5f);
  EXPECT_GT(mesh.normals[128].z, 0.5f);
  // A tip shared by all has the mean of its normals.
  EXPECT_NEAR(mesh.normals.back().z, 1, 1e-3);
}

TEST(Loft, IsSmoothWhereARingIsGivenOnce) {
  const Solid barrel =
      loft({level_circle(0.4f, 0), level_circle(0.5f, 0.5f), level_circle(0.4f, 1)});
  EXPECT_NEAR(barrel.mesh().normals[64].x, 1, 1e-3);
  EXPECT_NEAR(barrel.mesh().normals[64].z, 0, 1e-3);
}

}  // namespace
}  // namespace gloam

#include "render/scene/patterns/shape_mesh.h"

#include <cmath>

namespace gloam {
namespace {

/// A quad a, b, c, d, counter-clockwise, without triangles that have no area.
void add_quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d, std::vector<uint32_t>* indices) {
  indices->insert(indices->end(), {a, b, c, a, c, d});
}

TriangleMesh box_mesh(Vec3f half) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.positions.push_back({(k & 1) != 0 ? half.x : -half.x, (k & 2) != 0 ? half.y : -half.y,
                              (k & 4) != 0 ? half.z : -half.z});
  }
  add_quad(0, 2, 3, 1, &mesh.indices);
  add_quad(4, 5, 7, 6, &mesh.indices);
  add_quad(0, 1, 5, 4, &mesh.indices);
  add_quad(2, 6, 7, 3, &mesh.indices);
  add_quad(0, 4, 6, 2, &mesh.indices);
  add_quad(1, 3, 7, 5, &mesh.indices);
  return mesh;
}

TriangleMesh plane_mesh(Vec3f half, float horizon) {
  const float x = half.x > 0 ? half.x : horizon, y = half.y > 0 ? half.y : horizon;
  TriangleMesh mesh;
  mesh.positions = {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}};
  add_quad(0, 1, 2, 3, &mesh.indices);
  return mesh;
}

/// A profile (radius, z), from the bottom up, turned about z; y is stretched by `flat`.
TriangleMesh revolved(const std::vector<Vec2f>& profile, float flat) {
  TriangleMesh mesh;
  constexpr auto kColumns = static_cast<uint32_t>(kRoundSegments);
  for (const Vec2f& at : profile) {
    for (uint32_t j = 0; j < kColumns; ++j) {
      const float turn = 2 * kPi * static_cast<float>(j) / static_cast<float>(kColumns);
      mesh.positions.push_back({at.x * std::cos(turn), flat * at.x * std::sin(turn), at.y});
    }
  }
  for (uint32_t i = 0; i + 1 < profile.size(); ++i) {
    for (uint32_t j = 0; j < kColumns; ++j) {
      const uint32_t next = (j + 1) % kColumns, low = i * kColumns, high = low + kColumns;
      add_quad(low + j, low + next, high + next, high + j, &mesh.indices);
    }
  }
  return mesh;
}

/// Half a circle from the south pole to the north pole; its halves are `apart` along z.
std::vector<Vec2f> half_circle(float radius_x, float radius_z, float apart) {
  std::vector<Vec2f> profile;
  constexpr int kQuarter = kRoundSegments / 4;
  for (int half = 0; half < 2; ++half) {
    for (int i = 0; i <= kQuarter; ++i) {
      const float a = 0.5f * kPi * static_cast<float>(i + (half - 1) * kQuarter) / kQuarter;
      const float shift = half == 0 ? -0.5f * apart : 0.5f * apart;
      profile.push_back({radius_x * std::cos(a), radius_z * std::sin(a) + shift});
    }
  }
  return profile;
}

}  // namespace

TriangleMesh shape_mesh(ShapeType shape, Vec3f size, float horizon) {
  switch (shape) {
    case ShapeType::kPlane:
      return plane_mesh(size, horizon);
    case ShapeType::kBox:
      return box_mesh(size);
    case ShapeType::kSphere:
      return revolved(half_circle(size.x, size.x, 0), 1);
    case ShapeType::kEllipsoid:
      return revolved(half_circle(size.x, size.z, 0), size.y / size.x);
    case ShapeType::kCapsule:
      return revolved(half_circle(size.x, size.x, 2 * size.y), 1);
    case ShapeType::kCylinder:
      return revolved({{0, -size.y}, {size.x, -size.y}, {size.x, size.y}, {0, size.y}}, 1);
    default:
      return {};
  }
}

}  // namespace gloam

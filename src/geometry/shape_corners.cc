#include "geometry/shape_corners.h"

#include <cmath>

namespace gloam {
namespace {
constexpr int kShapeSides = 16;
}

void add_triangle(Vec3f a, Vec3f b, Vec3f c, ShapeCorners* out) {
  out->push_back(a), out->push_back(b), out->push_back(c);
}

void add_box_corners(Vec3f half, ShapeCorners* out) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      const auto at = [&](float u, float v) {
        float p[3];
        p[axis] = sign * half[axis];
        p[(axis + 1) % 3] = u * half[(axis + 1) % 3];
        p[(axis + 2) % 3] = v * half[(axis + 2) % 3];
        return Vec3f{p[0], p[1], p[2]};
      };
      add_triangle(at(-1, -1), at(1, -1), at(1, 1), out);
      add_triangle(at(-1, -1), at(1, 1), at(-1, 1), out);
    }
  }
}

void add_lathe_corners(const std::vector<Vec3f>& rings, ShapeCorners* out) {
  const auto at = [&](size_t ring, int side) {
    const float angle = 2 * kPi * static_cast<float>(side) / kShapeSides;
    const Vec3f r = rings[ring];
    return Vec3f{r.x * std::cos(angle), r.y * std::sin(angle), r.z};
  };
  for (int side = 0; side < kShapeSides; ++side) {
    for (size_t ring = 0; ring + 1 < rings.size(); ++ring) {
      add_triangle(at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), out);
      add_triangle(at(ring, side), at(ring + 1, side + 1), at(ring + 1, side), out);
    }
    add_triangle({0, 0, rings.front().z}, at(0, side), at(0, side + 1), out);
    add_triangle({0, 0, rings.back().z}, at(rings.size() - 1, side), at(rings.size() - 1, side + 1),
                 out);
  }
}

void add_ball_corners(Vec3f radii, float half_length, ShapeCorners* out) {
  std::vector<Vec3f> rings;
  constexpr int kRings = 4;  // rings of a half
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i < kRings; ++i) {
      const int k = side < 0 ? kRings - 1 - i : i;
      const float angle = 0.5f * kPi * static_cast<float>(k) / kRings;
      rings.push_back({radii.x * std::cos(angle), radii.y * std::cos(angle),
                       side * (half_length + radii.z * std::sin(angle))});
    }
  }
  rings.insert(rings.begin(), {0, 0, -half_length - radii.z});
  rings.push_back({0, 0, half_length + radii.z});
  add_lathe_corners(rings, out);
}

}  // namespace gloam

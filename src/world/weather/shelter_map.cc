#include "world/weather/shelter_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/shape_corners.h"
#include "world/render_description.h"

namespace gloam {
namespace {

constexpr float kCell = 0.1f;     // [m], at least
constexpr int kMostCells = 1024;  // along an edge
constexpr float kLargest = 1000;  // [m] of what belongs to a place

/// visit(three corners in the world) for all that stands still and is shown.
template <class Visit>
void each_triangle(const RenderDescription& description, const std::vector<Affine3f>& X_WB,
                   const Visit& visit) {
  for (const InstanceDescription& in : description.instances) {
    if (!in.is_static || !in.shown || !in.casts_shadow) continue;
    const Affine3f X_WG = X_WB[static_cast<size_t>(in.body)] * in.X_BG;
    const auto place = [&](Vec3f p) { return transform_point(X_WG, p); };
    const Vec3f s = in.size;
    ShapeCorners corners;
    switch (in.shape) {
      case ShapeType::kMesh: {
        const TriangleMesh& mesh = description.meshes[static_cast<size_t>(in.mesh)];
        for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
          visit(place(mesh.positions[mesh.indices[t]]), place(mesh.positions[mesh.indices[t + 1]]),
                place(mesh.positions[mesh.indices[t + 2]]));
        break;
      }
      case ShapeType::kBox:
        add_box_corners(s, &corners);
        break;
      case ShapeType::kSphere:
        add_ball_corners({s.x, s.x, s.x}, 0, &corners);
        break;
      case ShapeType::kEllipsoid:
        add_ball_corners(s, 0, &corners);
        break;
      case ShapeType::kCapsule:
        add_ball_corners({s.x, s.x, s.x}, s.y, &corners);
        break;
      case ShapeType::kCylinder:
        add_lathe_corners({{s.x, s.x, -s.y}, {s.x, s.x, s.y}}, &corners);
        break;
      case ShapeType::kPlane:  // ground
        visit(X_WG.p, X_WG.p, X_WG.p);
        break;
      case ShapeType::kDeformable:
        break;
    }
    for (size_t i = 0; i < corners.size(); i += 3)
      visit(place(corners[i]), place(corners[i + 1]), place(corners[i + 2]));
  }
}

/// Raises the cells whose middles lie under the triangle.
void raise(Vec3f a, Vec3f b, Vec3f c, ShelterMap* map) {
  const auto to_cells = [&](Vec3f p) {
    return Vec3f{(p.x - map->low.x) / map->cell - 0.5f, (p.y - map->low.y) / map->cell - 0.5f, p.z};
  };
  a = to_cells(a), b = to_cells(b), c = to_cells(c);
  const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (std::fabs(area) < 1e-12f) return;
  const auto clip = [](float low, float high, int n) {
    return std::pair{std::max(static_cast<int>(std::ceil(low)), 0),
                     std::min(static_cast<int>(std::floor(high)), n - 1)};
  };
  const auto [x0, x1] = clip(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), map->nx);
  const auto [y0, y1] = clip(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), map->ny);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const float px = static_cast<float>(x), py = static_cast<float>(y);
      const float v = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
      const float w = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
      if (v < 0 || w < 0 || v + w > 1) continue;
      float& top = map->height[static_cast<size_t>(y) * static_cast<size_t>(map->nx) +
                               static_cast<size_t>(x)];
      top = std::max(top, a.z + v * (b.z - a.z) + w * (c.z - a.z));
    }
  }
}

}  // namespace

std::shared_ptr<const ShelterMap> make_shelter_map(const RenderDescription& description,
                                                   const std::vector<Affine3f>& X_WB) {
  auto map = std::make_shared<ShelterMap>();
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Vec2f low{kFar, kFar}, high{-kFar, -kFar};
  const auto is_of_a_place = [](Vec3f p) {
    return std::fabs(p.x) < kLargest && std::fabs(p.y) < kLargest && std::isfinite(p.z);
  };
  map->lowest = kFar;
  each_triangle(description, X_WB, [&](Vec3f a, Vec3f b, Vec3f c) {
    for (const Vec3f& p : {a, b, c}) {
      if (!is_of_a_place(p)) continue;
      map->lowest = std::min(map->lowest, p.z);
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  });
  if (!std::isfinite(map->lowest)) map->lowest = 0;
  if (!(high.x > low.x) || !(high.y > low.y)) return map;
  const float edge = std::max(high.x - low.x, high.y - low.y);
  map->cell = std::max(kCell, edge / kMostCells);
  map->low = low;
  map->nx = std::min(static_cast<int>((high.x - low.x) / map->cell) + 1, kMostCells);
  map->ny = std::min(static_cast<int>((high.y - low.y) / map->cell) + 1, kMostCells);
  map->height.assign(static_cast<size_t>(map->nx) * static_cast<size_t>(map->ny), -kFar);
  each_triangle(description, X_WB, [&](Vec3f a, Vec3f b, Vec3f c) {
    if (is_of_a_place(a) && is_of_a_place(b) && is_of_a_place(c)) raise(a, b, c, map.get());
  });
  return map;
}

}  // namespace gloam

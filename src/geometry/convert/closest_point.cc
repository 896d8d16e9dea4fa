#include "geometry/convert/closest_point.h"

#include <algorithm>
#include <cmath>

#include "geometry/convert/mass.h"

namespace gloam {
namespace {

double squared_distance_to_box(Vec3d p, const BvhNode& node, size_t child) {
  const auto past = [](double x, double center, double half) {
    return std::max(std::abs(x - center) - half, 0.0);
  };
  const Vec3f c = node.center[child], h = node.half[child];
  return length_squared(Vec3d{past(p.x, c.x, h.x), past(p.y, c.y, h.y), past(p.z, c.z, h.z)});
}

double squared_distance_to_edge(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d ab = b - a;
  const double l = length_squared(ab);
  const double t = l > 0 ? std::clamp(dot(p - a, ab) / l, 0.0, 1.0) : 0;
  return length_squared(p - a - ab * t);
}

// Does the ray upwards from p, tilted slightly so that it does not run along faces, cross the
// triangle? Möller and Trumbore 1997.
constexpr Vec3d kRayDirection{0.0271828, 0.0314159, 1};
bool is_below(Vec3d p, const Triangle3d& t) {
  const Vec3d ab = t[1] - t[0], ac = t[2] - t[0];
  const Vec3d h = cross(kRayDirection, ac);
  const double det = dot(ab, h);
  if (det == 0) return false;
  const Vec3d from = p - t[0];
  const double u = dot(from, h) / det;
  if (u < 0 || u >= 1) return false;
  const Vec3d q = cross(from, ab);
  const double v = dot(kRayDirection, q) / det;
  return v >= 0 && u + v < 1 && dot(ac, q) / det > 0;
}

bool may_be_below(Vec3d p, const BvhNode& node, size_t child) {
  const Vec3f c = node.center[child], h = node.half[child];
  // The part of the ray within the box's slabs.
  double from = 0, to = 1e300;
  const auto cut = [&](double at, double direction, double center, double half) {
    const double a = (center - half - at) / direction, b = (center + half - at) / direction;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  };
  cut(p.x, kRayDirection.x, c.x, h.x), cut(p.y, kRayDirection.y, c.y, h.y),
      cut(p.z, kRayDirection.z, c.z, h.z);
  return from <= to;
}

}  // namespace

Triangle3d triangle_of(const TriangleMesh& mesh, size_t triangle) {
  const uint32_t* i = &mesh.indices[3 * triangle];
  return {wide(mesh.positions[i[0]]), wide(mesh.positions[i[1]]), wide(mesh.positions[i[2]])};
}

double squared_distance(Vec3d p, const Triangle3d& t) {
  const Vec3d ab = t[1] - t[0], ac = t[2] - t[0], n = cross(ab, ac), ap = p - t[0];
  const double nn = length_squared(n);
  if (nn > 0) {  // barycentric coordinates of the foot
    const double v = dot(cross(ap, ac), n) / nn, w = dot(cross(ab, ap), n) / nn;
    if (v >= 0 && w >= 0 && v + w <= 1) return dot(ap, n) * dot(ap, n) / nn;
  }
  return std::min({squared_distance_to_edge(p, t[0], t[1]), squared_distance_to_edge(p, t[1], t[2]),
                   squared_distance_to_edge(p, t[2], t[0])});
}

MeshQueries::MeshQueries(const TriangleMesh& mesh) : mesh_(mesh) {
  std::vector<BvhBox> boxes(mesh.triangle_count());
  for (size_t i = 0; i < mesh.indices.size() / 3 * 3; ++i)
    boxes[i / 3].add(mesh.positions[mesh.indices[i]]);
  tree_ = build_bvh(boxes, {});
}

double MeshQueries::distance(Vec3d p, double most) const {
  double best = most * most;
  struct Item {
    double squared;
    BvhRef ref;
  };
  std::array<Item, 2 * bvh::kMeshDepth> stack;
  size_t count = 0;
  if (tree_.root != bvh::kNothing) stack[count++] = {0, tree_.root};
  while (count > 0) {
    const Item item = stack[--count];
    if (item.squared >= best) continue;
    if ((item.ref & bvh::kKind) == bvh::kTriangles) {
      const uint32_t first = bvh::first_triangle(item.ref);
      for (uint32_t i = first; i < first + bvh::triangle_count(item.ref); ++i)
        best = std::min(best, squared_distance(p, triangle_of(mesh_, tree_.order[i])));
      continue;
    }
    const BvhNode& node = tree_.nodes[item.ref];
    Item children[2];
    for (size_t k = 0; k < 2; ++k) {
      const bool is_there = node.child[k] != bvh::kNothing;
      children[k] = {is_there ? squared_distance_to_box(p, node, k) : 1e300, node.child[k]};
    }
    if (children[0].squared < children[1].squared) std::swap(children[0], children[1]);
    for (const Item& child : children)  // the nearer is on top
      if (child.ref != bvh::kNothing && child.squared < best) stack[count++] = child;
  }
  return std::sqrt(best);
}

bool MeshQueries::is_inside(Vec3d p) const {
  std::array<BvhRef, 2 * bvh::kMeshDepth> stack;
  size_t count = 0;
  if (tree_.root != bvh::kNothing) stack[count++] = tree_.root;
  int above = 0;
  while (count > 0) {
    const BvhRef ref = stack[--count];
    if ((ref & bvh::kKind) == bvh::kTriangles) {
      const uint32_t first = bvh::first_triangle(ref);
      for (uint32_t i = first; i < first + bvh::triangle_count(ref); ++i)
        above += is_below(p, triangle_of(mesh_, tree_.order[i])) ? 1 : 0;
      continue;
    }
    const BvhNode& node = tree_.nodes[ref];
    for (size_t k = 0; k < 2; ++k)
      if (node.child[k] != bvh::kNothing && may_be_below(p, node, k))
        stack[count++] = node.child[k];
  }
  return above % 2 == 1;
}

std::vector<SurfacePoint> sample_surface(const TriangleMesh& mesh, size_t count) {
  std::vector<double> areas(mesh.triangle_count());
  double all = 0;
  for (size_t t = 0; t < areas.size(); ++t) {
    const Triangle3d corner = triangle_of(mesh, t);
    all += std::sqrt(length_squared(cross(corner[1] - corner[0], corner[2] - corner[0])));
    areas[t] = all;
  }
  std::vector<SurfacePoint> out;
  if (!(all > 0)) return out;
  out.reserve(count);
  size_t t = 0;
  // Along the list of triangles by area, within each by Roberts' R2 sequence (2018), folded.
  constexpr double kPlasticNumber = 1.32471795724474602596;
  for (size_t i = 0; i < count; ++i) {
    const double at = all * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    while (t + 1 < areas.size() && areas[t] <= at) ++t;
    const auto n = static_cast<double>(i + 1);
    double u = std::fmod(n / kPlasticNumber, 1.0),
           v = std::fmod(n / (kPlasticNumber * kPlasticNumber), 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Triangle3d corner = triangle_of(mesh, t);
    const Vec3d along = corner[1] - corner[0], aside = corner[2] - corner[0];
    const Vec3d normal = cross(along, aside);
    out.push_back(
        {corner[0] + along * u + aside * v, normal * (1 / std::sqrt(length_squared(normal)))});
  }
  return out;
}

}  // namespace gloam

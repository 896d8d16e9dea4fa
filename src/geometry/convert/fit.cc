#include "geometry/convert/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/convert/hull.h"
#include "geometry/convert/mass.h"

namespace gloam {
namespace {

constexpr int kMostCorners = 256;  // corners of the hull by which directions are searched

using Points = std::vector<Vec3d>;

Vec3d unit(Vec3d v) { return v * (1 / length_of(v)); }

Points points_of(const TriangleMesh& mesh) {
  Points out;
  for (const Vec3f p : mesh.positions) out.push_back({p.x, p.y, p.z});
  return out;
}

AffineOf<double> frame_with_z(Vec3d z) {
  const FrameOf<double> frame = [&] {  // Frame::from_z in doubles
    const double sign = z.z < 0 ? -1 : 1, a = -1 / (sign + z.z), b = z.x * z.y * a;
    return FrameOf<double>{
        {1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
  }();
  return {frame.x, frame.y, frame.z, {}};
}

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double v) { low = std::min(low, v), high = std::max(high, v); }
  double middle() const { return (low + high) / 2; }
  double half() const { return (high - low) / 2; }
};

Interval extent(const Points& points, Vec3d direction) {
  Interval out;
  for (const Vec3d& p : points) out.add(dot(p, direction));
  return out;
}

// Distinct directions of faces, those of most area first.
std::vector<Vec3d> face_normals(const TriangleMesh& hull) {
  struct Facet {
    Vec3d normal;
    double area;
  };
  std::vector<Facet> facets;
  for (size_t t = 0; t + 2 < hull.indices.size(); t += 3) {
    const auto at = [&](size_t k) {
      const Vec3f p = hull.positions[hull.indices[t + k]];
      return Vec3d{p.x, p.y, p.z};
    };
    const Vec3d n = cross(at(1) - at(0), at(2) - at(0));
    const double area = length_of(n);
    if (!(area > 0)) continue;
    const Vec3d normal = n * (1 / area);
    const auto same = std::find_if(facets.begin(), facets.end(), [&](const Facet& f) {
      return std::abs(dot(f.normal, normal)) > 1 - 1e-10;
    });
    if (same != facets.end())
      same->area += area;
    else
      facets.push_back({normal, area});
  }
  std::stable_sort(facets.begin(), facets.end(),
                   [](const Facet& a, const Facet& b) { return a.area > b.area; });
  std::vector<Vec3d> out;
  for (const Facet& f : facets) out.push_back(f.normal);
  return out;
}

// Corners of the convex outline of the points seen along the frame's z (Andrew 1979).
std::vector<Vec2Of<double>> outline(const Points& points, const AffineOf<double>& frame) {
  std::vector<Vec2Of<double>> flat, out;
  for (const Vec3d& p : points) flat.push_back({dot(p, frame.x), dot(p, frame.y)});
  std::sort(flat.begin(), flat.end(),
            [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto half = [&](auto begin, auto end) {
    const size_t base = out.size();
    for (auto p = begin; p != end; ++p) {
      while (out.size() >= base + 2) {
        const auto a = out.back() - out[out.size() - 2], b = *p - out[out.size() - 2];
        if (a.x * b.y - a.y * b.x > 0) break;
        out.pop_back();
      }
      out.push_back(*p);
    }
    out.pop_back();
  };
  half(flat.begin(), flat.end());
  half(flat.rbegin(), flat.rend());
  return out;
}

// Axes of the box: z along `normal`, x along the edge of the outline that gives the least area.
struct Rectangle {
  AffineOf<double> frame;
  double area;
};
Rectangle least_rectangle(const Points& points, Vec3d normal) {
  const AffineOf<double> frame = frame_with_z(normal);
  const std::vector<Vec2Of<double>> corners = outline(points, frame);
  Rectangle best{frame, std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto edge = corners[(i + 1) % corners.size()] - corners[i];
    const double l = std::hypot(edge.x, edge.y);
    if (!(l > 0)) continue;
    const Vec2Of<double> u{edge.x / l, edge.y / l};
    Interval along, across;
    for (const auto& c : corners)
      along.add(c.x * u.x + c.y * u.y), across.add(c.y * u.x - c.x * u.y);
    const double area = along.half() * across.half();
    if (area >= best.area) continue;
    const Vec3d x = frame.x * u.x + frame.y * u.y;
    best = {{x, cross(frame.z, x), frame.z, {}}, area};
  }
  return best;
}

double radius_about(const Points& points, Vec3d center) {
  double squared = 0;
  for (const Vec3d& p : points) squared = std::max(squared, length_squared(p - center));
  return std::sqrt(squared);
}

// Center of the smallest ball around points, within a thousandth (Badoiu and Clarkson 2003: each
// step a little towards the farthest).
Vec3d ball_center(const Points& points) {
  constexpr int kMoves = 1000;
  const Interval x = extent(points, {1, 0, 0}), y = extent(points, {0, 1, 0}),
                 z = extent(points, {0, 0, 1});
  Vec3d center{x.middle(), y.middle(), z.middle()}, best = center;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < kMoves; ++i) {
    const Vec3d* farthest = &points[0];
    double squared = 0;
    for (const Vec3d& p : points)
      if (const double d = length_squared(p - center); d > squared) squared = d, farthest = &p;
    if (squared < least) least = squared, best = center;
    center += (*farthest - center) * (1.0 / (i + 1));
  }
  return best;
}

TriangleMesh reduced(const TriangleMesh& hull) {
  if (hull.positions.size() <= kMostCorners) return hull;
  return convex_hull(hull.positions, {.vertices = kMostCorners});
}

// The solid of revolution along the axis; `few` finds its middle, `all` are within it.
MeshCollider around_axis(MeshColliderType type, const Points& few, const Points& all, Vec3d axis) {
  MeshCollider out;
  out.type = type;
  out.X_MG = frame_with_z(axis);
  Points flat;
  for (const Vec3d& p : few) flat.push_back(p - axis * dot(p, axis));
  const Vec3d center = ball_center(flat);
  double squared = 0;
  for (const Vec3d& p : all)
    squared = std::max(squared, length_squared(p - axis * dot(p, axis) - center));
  const double radius = std::sqrt(squared);
  Interval along;
  if (type == MeshColliderType::kCylinder) {
    along = extent(all, axis);
  } else {  // the caps reach past a point by what is left beside it
    for (const Vec3d& p : all) {
      const double t = dot(p, axis);
      const double cap = std::sqrt(std::max(squared - length_squared(p - axis * t - center), 0.0));
      along.low = std::min(along.low, t + cap);
      along.high = std::max(along.high, t - cap);
    }
    if (along.low > along.high) along.low = along.high = along.middle();
  }
  out.size = {radius, along.half(), 0};
  out.X_MG.p = center + axis * along.middle();
  return out;
}

MeshCollider least_around_axes(MeshColliderType type, const TriangleMesh& hull, const Points& few) {
  const Points all = points_of(hull);
  const AffineOf<double> box = box_around(hull).X_MG;
  MeshCollider best;
  double volume = std::numeric_limits<double>::infinity();
  const auto try_axis = [&](Vec3d axis) {
    MeshCollider made = around_axis(type, few, all, axis);
    const double v = volume_of(made);
    if (v >= volume) return false;
    volume = v;
    best = std::move(made);
    return true;
  };
  for (const Vec3d& axis : {box.x, box.y, box.z}) try_axis(axis);
  if (type != MeshColliderType::kCapsule) return best;
  for (double tilt = 0.2; tilt > 1e-3; tilt /= 2) {  // [rad]
    const AffineOf<double> X = best.X_MG;
    for (const Vec3d& side : {X.x, -X.x, X.y, -X.y}) try_axis(unit(X.z + side * tilt));
  }
  return best;
}

}  // namespace

MeshCollider box_around(const TriangleMesh& hull) {
  const TriangleMesh few = reduced(hull);
  const Points corners = points_of(few), all = points_of(hull);
  AffineOf<double> axes;
  double volume = std::numeric_limits<double>::infinity();
  for (const Vec3d& normal : face_normals(few)) {
    const Rectangle r = least_rectangle(corners, normal);
    const double v = r.area * extent(corners, normal).half();
    if (v < volume * (1 - 1e-9)) volume = v, axes = r.frame;
  }
  MeshCollider out;
  out.type = MeshColliderType::kBox;
  const Interval x = extent(all, axes.x), y = extent(all, axes.y), z = extent(all, axes.z);
  out.size = {x.half(), y.half(), z.half()};
  out.X_MG = axes;
  out.X_MG.p = axes.x * x.middle() + axes.y * y.middle() + axes.z * z.middle();
  return out;
}

MeshCollider sphere_around(const TriangleMesh& hull) {
  MeshCollider out;
  out.type = MeshColliderType::kSphere;
  out.X_MG.p = ball_center(points_of(reduced(hull)));
  out.size.x = radius_about(points_of(hull), out.X_MG.p);
  return out;
}

MeshCollider cylinder_around(const TriangleMesh& hull) {
  return least_around_axes(MeshColliderType::kCylinder, hull, points_of(reduced(hull)));
}

MeshCollider capsule_around(const TriangleMesh& hull) {
  return least_around_axes(MeshColliderType::kCapsule, hull, points_of(reduced(hull)));
}

}  // namespace gloam

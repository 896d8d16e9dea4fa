#include "geometry/convert/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "geometry/convert/closest_point.h"
#include "geometry/convert/coarsen.h"
#include "geometry/convert/fit.h"
#include "geometry/convert/hull.h"

namespace gloam {
namespace {

constexpr double kRoomHeight = 1.5, kRoomWidth = 0.8;  // the least that one stands in [m]
constexpr size_t kMostTriangles = 8000;                // larger shells are made coarser
constexpr size_t kEnoughPieces = 256;
constexpr double kThickest = 0.1, kThickness = 0.05, kThinnest = 0.01;  // thickness of slabs [m]
constexpr double kDepthStep = 0.02;                                     // [m]
constexpr size_t kDepthSamples = 64;                                    // samples of a piece
constexpr double kMinFaceCosine = 0.7;  // least cosine between the normals of what is one face

/// Tolerances of one face: `rough` = distance from its plane [m]; `gaps` = fraction of its
/// outline's hull that is no part of it, and the same as an area [m²]. More is allowed where a slab
/// does not reach into the air, which can be tested for closed shells.
struct Slack {
  double rough, gaps, gap_area;
};
constexpr std::array<Slack, 6> kFaceTolerances = {{{0.001, 0.005, 0.005},
                                                   {0.003, 0.02, 0.02},
                                                   {0.006, 0.04, 0.05},
                                                   {0.012, 0.08, 0.1},
                                                   {0.025, 0.15, 0.2},
                                                   {0.05, 0.3, 0.3}}};
constexpr double kGapStep = 0.15, kBehind = 0.01;  // between points that are tried, behind it [m]

struct Plane2 {
  Vec3d u, v, n;
};
Plane2 axes_of(Vec3d normal) {
  const Vec3d n = normal * (1 / length_of(normal));
  const Vec3d other = std::abs(n.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  Vec3d u = cross(other, n);
  u = u * (1 / length_of(u));
  return {u, cross(n, u), n};
}

/// Triangles that are one face.
struct Piece {
  std::vector<Vec3d> points;      // its corners, and the points farthest from its plane
  Vec3d area;                     // sum of the triangles' [m^2]
  std::vector<size_t> triangles;  // empty = it is part of another
};

/// Corners of the outline's hull, counter-clockwise seen against the normal (Andrew 1979), and the
/// points farthest above and below the plane.
struct Outline {
  std::vector<Vec3d> corners;
  double area = 0, low = 0, high = 0;  // [m^2], along the normal [m]
  Vec3d lowest, highest;
};
Outline outline_of(const std::vector<Vec3d>& points, const Plane2& axes) {
  struct Flat {
    double x, y;
    size_t point;
  };
  std::vector<Flat> flat;
  Outline out;
  out.low = INFINITY, out.high = -INFINITY;
  for (size_t i = 0; i < points.size(); ++i) {
    flat.push_back({dot(points[i], axes.u), dot(points[i], axes.v), i});
    const double height = dot(points[i], axes.n);
    if (height < out.low) out.low = height, out.lowest = points[i];
    if (height > out.high) out.high = height, out.highest = points[i];
  }
  std::sort(flat.begin(), flat.end(),
            [](const Flat& a, const Flat& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Flat> hull;
  const auto add = [&](const Flat& p, size_t least) {
    const auto turns_left = [&] {
      const Flat &a = hull[hull.size() - 2], &b = hull.back();
      return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0;
    };
    while (hull.size() > least && !turns_left()) hull.pop_back();
    hull.push_back(p);
  };
  for (const Flat& p : flat) add(p, 1);
  const size_t lower = hull.size();
  for (size_t i = flat.size(); i-- > 0;) add(flat[i], lower);
  for (size_t i = 0; i + 1 < hull.size(); ++i) {
    out.area += (hull[i].x * hull[i + 1].y - hull[i + 1].x * hull[i].y) / 2;
    out.corners.push_back(points[hull[i].point]);
  }
  return out;
}

class Faces {
 public:
  /// `air` = the shell's, if it is closed.
  Faces(const TriangleMesh& shell, const MeshQueries* air)
      : shell_(shell),
        air_(air),
        size_(length(2.0f * half_extents_of(shell))),
        owner_(shell.triangle_count()) {
    std::iota(owner_.begin(), owner_.end(), size_t{0});
    for (size_t t = 0; t < owner_.size(); ++t) {
      const Triangle3d c = triangle_of(shell, t);
      pieces_.push_back(
          {{c[0], c[1], c[2]}, cross(c[1] - c[0], c[2] - c[0]) * 0.5, std::vector<size_t>{t}});
    }
    count_ = owner_.size();
    find_edges();
    for (const Slack& slack : kFaceTolerances) {
      join(slack);
      if (count_ <= kEnoughPieces) break;
    }
  }

  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  static Vec3f half_extents_of(const TriangleMesh& mesh) {
    BvhBox box;
    for (const Vec3f p : mesh.positions) box.add(p);
    return (box.high - box.low) * 0.5f;
  }

  struct Edge {
    size_t a, b;
    double length;
  };

  // Longest first: the diagonal of a rectangle is longer than its sides.
  void find_edges() {
    std::map<std::pair<uint32_t, uint32_t>, size_t> first;
    for (size_t i = 0; i < shell_.indices.size() / 3 * 3; ++i) {
      const uint32_t from = shell_.indices[i], to = shell_.indices[i % 3 == 2 ? i - 2 : i + 1];
      const auto key = std::minmax(from, to);
      const auto [other, is_new] = first.try_emplace(key, i / 3);
      if (is_new || other->second == i / 3) continue;
      const Vec3f along = shell_.positions[from] - shell_.positions[to];
      edges_.push_back({other->second, i / 3, length(along)});
    }
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const Edge& a, const Edge& b) { return a.length > b.length; });
  }

  size_t owner(size_t triangle) {
    while (owner_[triangle] != triangle) triangle = owner_[triangle] = owner_[owner_[triangle]];
    return triangle;
  }

  void join(const Slack& slack) {
    for (bool is_any = true; is_any && count_ > 1;) {
      is_any = false;
      for (const Edge& edge : edges_) {
        const size_t a = owner(edge.a), b = owner(edge.b);
        if (a != b && try_to_join(a, b, slack)) is_any = true;
      }
    }
  }

  bool try_to_join(size_t into, size_t other, const Slack& slack) {
    Piece &a = pieces_[into], &b = pieces_[other];
    const double size_a = length_of(a.area), size_b = length_of(b.area);
    if (dot(a.area, b.area) < kMinFaceCosine * size_a * size_b) return false;
    const Vec3d area = a.area + b.area;
    if (!(length_of(area) > 0)) return false;
    std::vector<Vec3d> points = a.points;
    points.insert(points.end(), b.points.begin(), b.points.end());
    const Outline outline = outline_of(points, axes_of(area));
    if (outline.high - outline.low > 2 * slack.rough) return false;
    const double gaps = outline.area - length_of(area);
    const bool is_filled = gaps <= slack.gaps * length_of(area) && gaps <= slack.gap_area;
    if (!is_filled && (air_ == nullptr || reaches_into_air(outline, axes_of(area).n))) return false;
    a.points = outline.corners;
    if (outline.high - outline.low > 1e-6 * size_)
      a.points.insert(a.points.end(), {outline.lowest, outline.highest});
    a.area = area;
    a.triangles.insert(a.triangles.end(), b.triangles.begin(), b.triangles.end());
    b = {};
    owner_[other] = into;
    --count_;
    return true;
  }

  // Just behind the face, is there air that its outline's hull would take?
  bool reaches_into_air(const Outline& outline, Vec3d n) const {
    TriangleMesh hull;
    for (const Vec3d& corner : outline.corners) {
      const Vec3d p = corner + n * (outline.low - kBehind - dot(corner, n));
      hull.positions.push_back(
          {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    for (uint32_t k = 2; k < hull.positions.size(); ++k)
      hull.indices.insert(hull.indices.end(), {0, k - 1, k});
    const double count = std::clamp(outline.area / (kGapStep * kGapStep), 16.0, 1024.0);
    const std::vector<SurfacePoint> points = sample_surface(hull, static_cast<size_t>(count));
    return std::any_of(points.begin(), points.end(),
                       [&](const SurfacePoint& s) { return air_->is_inside(s.p); });
  }

  const TriangleMesh& shell_;
  const MeshQueries* air_;
  const double size_;  // diagonal [m]
  std::vector<size_t> owner_;
  std::vector<Piece> pieces_;  // pieces by the triangle that owns each
  std::vector<Edge> edges_;
  size_t count_ = 0;
};

// Depth behind the face without air.
double thickness_behind(const Piece& piece, const TriangleMesh& shell, const MeshQueries& air) {
  const Vec3d n = piece.area * (1 / length_of(piece.area));
  const size_t stride = piece.triangles.size() / kDepthSamples + 1;
  double thickness = kThickest;
  for (size_t i = 0; i < piece.triangles.size(); i += stride) {
    const Triangle3d c = triangle_of(shell, piece.triangles[i]);
    const Vec3d middle = (c[0] + c[1] + c[2]) * (1.0 / 3);
    for (const Vec3d& corner : {middle, c[0] + (middle - c[0]) * 0.1, c[1] + (middle - c[1]) * 0.1,
                                c[2] + (middle - c[2]) * 0.1})
      for (double depth = kDepthStep; depth <= thickness; depth += kDepthStep)
        if (air.is_inside(corner - n * depth)) thickness = depth - kDepthStep;
  }
  return std::max(thickness, kThinnest);
}

}  // namespace

bool is_room_sized(const TriangleMesh& shell) {
  BvhBox box;
  for (const Vec3f p : shell.positions) box.add(p);
  const Vec3f side = box.high - box.low;
  return std::min(side.x, side.y) >= kRoomWidth && side.z >= kRoomHeight;
}

double enclosed_volume(const TriangleMesh& shell) {
  BvhBox box;
  for (const Vec3f p : shell.positions) box.add(p);
  const Vec3d middle = wide((box.low + box.high) * 0.5f);
  double volume = 0;
  for (size_t t = 0; t < shell.triangle_count(); ++t) {
    const Triangle3d c = triangle_of(shell, t);
    volume += dot(c[0] - middle, cross(c[1] - middle, c[2] - middle)) / 6;
  }
  return volume;
}

std::vector<MeshCollider> slabs_behind(const TriangleMesh& shell, bool closed) {
  const TriangleMesh coarse = coarsened(shell, kMostTriangles);
  const MeshQueries air(coarse);
  const Faces faces(coarse, closed ? &air : nullptr);
  std::vector<MeshCollider> slabs;
  for (const Piece& piece : faces.pieces()) {
    if (piece.triangles.empty() || !(length_of(piece.area) > 0)) continue;
    const Vec3d n = piece.area * (1 / length_of(piece.area));
    const double thickness = closed ? thickness_behind(piece, coarse, air) : kThickness;
    std::vector<Vec3f> points;
    for (const Vec3d& p : piece.points)
      for (const Vec3d& q : {p, p - n * thickness})
        points.push_back(
            {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
    MeshCollider slab;
    slab.hull = convex_hull(points);
    if (slab.hull.indices.empty()) continue;
    MeshCollider box = box_around(slab.hull);  // cheaper, where it is one
    if (volume_of(box) < 1.001 * volume_of(slab)) slab = std::move(box);
    slabs.push_back(std::move(slab));
  }
  return slabs;
}

}  // namespace gloam

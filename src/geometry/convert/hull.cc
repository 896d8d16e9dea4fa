// Quickhull (Barber, Dobkin and Huhdanpaa 1996) over points on a grid of 2^20 steps: all tests are
// exact in 64 bits, so no rounding ever breaks the surface. Faces that a new point lies in the
// plane of are replaced too, therefore no triangle is without area.

#include "geometry/convert/hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace gloam {
namespace {

constexpr int64_t kSteps = int64_t{1} << 20;
constexpr double kFlatSteps = 2;  // thickness of what counts as flat [steps]

struct Int3 {
  int64_t x = 0, y = 0, z = 0;
  friend Int3 operator-(const Int3& a, const Int3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Int3 cross(const Int3& a, const Int3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  // |normal| <= 2^41 and |difference| <= 2^20 a component: below 2^63.
  friend int64_t dot(const Int3& a, const Int3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  double length() const {
    const auto d = [](int64_t v) { return static_cast<double>(v); };
    return std::sqrt(d(x) * d(x) + d(y) * d(y) + d(z) * d(z));
  }
};

struct Face {
  std::array<int, 3> corner;
  std::array<int, 3> beyond = {-1, -1, -1};  // face across the edge from corner i to corner i + 1
  Int3 normal;
  std::vector<int> outside;  // points above it that no other face has
  int farthest = -1;
  int64_t height = 0;  // height of the farthest point, times the normal's length
  bool is_dead = false;
  int visit = -1;  // point by which it was visited last
};

class Quickhull {
 public:
  Quickhull(std::span<const Vec3f> points, const HullLimits& limits) : points_(points) {
    snap();
    const std::array<int, 4> start = simplex();
    if (start[3] < 0) return;
    vertices_ = 4;
    begin_with(start);
    while (!queue_.empty() && vertices_ < limits.vertices) {
      const auto [height, face] = queue_.top();
      queue_.pop();
      if (faces_[face].is_dead) continue;
      if (height * step_ < limits.tolerance) break;
      add_point(static_cast<int>(face));
      ++vertices_;
    }
  }

  TriangleMesh mesh() const {
    TriangleMesh out;
    std::vector<uint32_t> index(points_.size(), UINT32_MAX);
    for (const Face& face : faces_) {
      if (face.is_dead) continue;
      for (const int corner : face.corner) {
        uint32_t& known = index[static_cast<size_t>(corner)];
        if (known == UINT32_MAX) {
          known = static_cast<uint32_t>(out.positions.size());
          out.positions.push_back(points_[static_cast<size_t>(corner)]);
        }
        out.indices.push_back(known);
      }
    }
    return out;
  }

 private:
  void snap() {
    if (points_.empty()) return;
    Vec3f low = points_[0], high = low;
    for (const Vec3f p : points_) {
      low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
      high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
    }
    const double side =
        std::max({double{high.x} - low.x, double{high.y} - low.y, double{high.z} - low.z});
    if (!(side > 0)) return;
    step_ = side / kSteps;
    grid_.reserve(points_.size());
    const auto step_of = [&](float v, float from) {
      return static_cast<int64_t>(std::llround((double{v} - from) / step_));
    };
    for (const Vec3f p : points_)
      grid_.push_back({step_of(p.x, low.x), step_of(p.y, low.y), step_of(p.z, low.z)});
  }

  const Int3& at(int point) const { return grid_[static_cast<size_t>(point)]; }

  template <class Measure>
  int largest(Measure measure, double above) const {
    int best = -1;
    for (int i = 0; i < static_cast<int>(grid_.size()); ++i) {
      const double value = measure(at(i));
      if (value > above) above = value, best = i;
    }
    return best;
  }

  // Four points far apart, counter-clockwise seen from the fourth's far side; the last is -1 where
  // the points are flat.
  std::array<int, 4> simplex() const {
    constexpr std::array<int, 4> kNone = {-1, -1, -1, -1};
    if (grid_.empty()) return kNone;
    const int a = largest([&](const Int3& p) { return (p - at(0)).length(); }, -1);
    const int b = largest([&](const Int3& p) { return (p - at(a)).length(); }, kFlatSteps);
    if (b < 0) return kNone;
    const Int3 ab = at(b) - at(a);
    const int c = largest([&](const Int3& p) { return cross(ab, p - at(a)).length(); },
                          kFlatSteps * ab.length());
    if (c < 0) return kNone;
    const Int3 normal = cross(ab, at(c) - at(a));
    const auto height = [&](const Int3& p) { return dot(normal, p - at(a)); };
    const int d = largest([&](const Int3& p) { return std::abs(static_cast<double>(height(p))); },
                          kFlatSteps * normal.length());
    if (d < 0) return kNone;
    if (height(at(d)) > 0) return {a, c, b, d};
    return {a, b, c, d};
  }

  int new_face(int a, int b, int c) {
    Face face;
    face.corner = {a, b, c};
    face.normal = cross(at(b) - at(a), at(c) - at(a));
    faces_.push_back(std::move(face));
    return static_cast<int>(faces_.size()) - 1;
  }
  Face& face(int index) { return faces_[static_cast<size_t>(index)]; }
  int64_t height(const Face& face, int point) const {
    return dot(face.normal, at(point) - at(face.corner[0]));
  }

  void begin_with(const std::array<int, 4>& s) {
    new_face(s[0], s[1], s[2]);
    new_face(s[1], s[0], s[3]);
    new_face(s[2], s[1], s[3]);
    new_face(s[0], s[2], s[3]);
    face(0).beyond = {1, 2, 3};
    face(1).beyond = {0, 3, 2};
    face(2).beyond = {0, 1, 3};
    face(3).beyond = {0, 2, 1};
    first_new_ = 0;
    for (int i = 0; i < static_cast<int>(grid_.size()); ++i) assign(i);
    enqueue_new();
  }

  // To the first of the new faces that it is above; a point above none is inside for good.
  void assign(int point) {
    for (size_t f = first_new_; f < faces_.size(); ++f) {
      Face& face = faces_[f];
      const int64_t above = height(face, point);
      if (above <= 0) continue;
      face.outside.push_back(point);
      if (above > face.height) face.height = above, face.farthest = point;
      return;
    }
  }

  void enqueue_new() {
    for (size_t f = first_new_; f < faces_.size(); ++f) {
      const Face& face = faces_[f];
      if (face.farthest >= 0)
        queue_.push({static_cast<double>(face.height) / face.normal.length(), f});
    }
  }

  // Replaces all faces that the farthest point above `seed` sees, or lies in the plane of.
  void add_point(int seed) {
    const int point = face(seed).farthest;
    seen_.assign(1, seed);
    horizon_.clear();
    face(seed).visit = point;
    face(seed).is_dead = true;
    for (size_t i = 0; i < seen_.size(); ++i) {
      const Face& from = face(seen_[i]);
      for (size_t edge = 0; edge < 3; ++edge) {
        const int next = from.beyond[edge];
        Face& to = face(next);
        if (to.visit != point) {
          to.visit = point;
          if (height(to, point) >= 0) {
            to.is_dead = true;
            seen_.push_back(next);
          }
        }
        if (!to.is_dead) horizon_.push_back({from.corner[edge], from.corner[(edge + 1) % 3], next});
      }
    }
    first_new_ = faces_.size();
    if (starting_at_.empty()) starting_at_.assign(points_.size(), -1);
    for (const Edge& edge : horizon_) {
      const int added = new_face(edge.from, edge.to, point);
      starting_at_[static_cast<size_t>(edge.from)] = added;
      face(added).beyond[0] = edge.beyond;
      Face& beyond = face(edge.beyond);
      for (size_t k = 0; k < 3; ++k)
        if (beyond.corner[k] == edge.to && beyond.corner[(k + 1) % 3] == edge.from)
          beyond.beyond[k] = added;
    }
    for (size_t f = first_new_; f < faces_.size(); ++f) {
      const int next = starting_at_[static_cast<size_t>(faces_[f].corner[1])];
      faces_[f].beyond[1] = next;
      face(next).beyond[2] = static_cast<int>(f);
    }
    for (const int old : seen_) {
      const std::vector<int> outside = std::move(face(old).outside);
      for (const int other : outside)
        if (other != point) assign(other);
    }
    enqueue_new();
  }

  struct Edge {
    int from, to, beyond;
  };
  std::span<const Vec3f> points_;
  double step_ = 0;  // [m]
  std::vector<Int3> grid_;
  std::vector<Face> faces_;
  size_t first_new_ = 0;
  int vertices_ = 0;
  std::priority_queue<std::pair<double, size_t>> queue_;  // height of the farthest [steps], face
  std::vector<int> seen_, starting_at_;
  std::vector<Edge> horizon_;
};

}  // namespace

TriangleMesh convex_hull(std::span<const Vec3f> points, const HullLimits& limits) {
  return Quickhull(points, limits).mesh();
}

}  // namespace gloam

#include "geometry/mesh/triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "geometry/mesh/model_limits.h"

namespace gloam {
namespace {

struct Point {
  double x, y;
};

// > 0: a, b, c turn left.
double turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_inside(Point p, Point a, Point b, Point c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

// The polygon in the coordinate plane that it faces most, counter-clockwise there (Newell's
// normal).
std::vector<Point> flatten(std::span<const Vec3f> positions, std::span<const uint32_t> corners) {
  double nx = 0, ny = 0, nz = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3f a = positions[corners[i]], b = positions[corners[(i + 1) % corners.size()]];
    nx += (double{a.y} - b.y) * (double{a.z} + b.z);
    ny += (double{a.z} - b.z) * (double{a.x} + b.x);
    nz += (double{a.x} - b.x) * (double{a.y} + b.y);
  }
  const double ax = std::abs(nx), ay = std::abs(ny), az = std::abs(nz);
  std::vector<Point> out(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3f p = positions[corners[i]];
    if (az >= ax && az >= ay)
      out[i] = nz >= 0 ? Point{p.x, p.y} : Point{p.y, p.x};
    else if (ax >= ay)
      out[i] = nx >= 0 ? Point{p.y, p.z} : Point{p.z, p.y};
    else
      out[i] = ny >= 0 ? Point{p.z, p.x} : Point{p.x, p.z};
  }
  return out;
}

bool is_convex(std::span<const Point> p) {
  const size_t n = p.size();
  for (size_t i = 0; i < n; ++i)
    if (!(turn(p[i], p[(i + 1) % n], p[(i + 2) % n]) >= 0)) return false;
  return true;
}

// Ears are cut off a ring of corners until a triangle is left.
class EarCutter {
 public:
  explicit EarCutter(std::span<const Point> p) : p_(p), next_(p.size()), before_(p.size()) {
    for (size_t i = 0; i < p.size(); ++i) {
      next_[i] = static_cast<uint32_t>((i + 1) % p.size());
      before_[i] = static_cast<uint32_t>((i + p.size() - 1) % p.size());
    }
  }
  template <class F>
  void cut(F&& put) {
    size_t left = p_.size(), tried = 0, all_tries = 0;
    uint32_t at = 0;
    bool stuck = false;
    while (left > 3) {
      // A ring without an ear touches or crosses itself: what is left of it is cut as it comes.
      // Real polygons need a few tries per corner; hostile ones get no more time than that.
      if (tried > left || all_tries > 16 * p_.size()) stuck = true;
      if (!stuck && !is_ear(at)) {
        at = next_[at];
        ++tried;
        ++all_tries;
        continue;
      }
      const uint32_t a = before_[at], c = next_[at];
      put(a, at, c);
      next_[a] = c;
      before_[c] = a;
      at = c;
      tried = 0;
      --left;
    }
    put(before_[at], at, next_[at]);
  }

 private:
  bool is_ear(uint32_t i) const {
    const uint32_t a = before_[i], c = next_[i];
    if (!(turn(p_[a], p_[i], p_[c]) > 0)) return false;
    for (uint32_t k = next_[c]; k != a; k = next_[k]) {
      const Point p = p_[k];
      const auto same = [p](Point q) { return p.x == q.x && p.y == q.y; };
      if (same(p_[a]) || same(p_[i]) || same(p_[c])) continue;
      if (turn(p_[before_[k]], p, p_[next_[k]]) <= 0 && is_inside(p, p_[a], p_[i], p_[c]))
        return false;
    }
    return true;
  }
  std::span<const Point> p_;
  std::vector<uint32_t> next_, before_;
};

bool triangulate(std::span<const Vec3f> positions, std::span<const uint32_t> corners,
                 uint32_t* out) {
  const auto put = [&](size_t a, size_t b, size_t c) {
    *out++ = corners[a];
    *out++ = corners[b];
    *out++ = corners[c];
  };
  if (corners.size() == 3) {
    put(0, 1, 2);
    return true;
  }
  const std::vector<Point> flat = flatten(positions, corners);
  if (is_convex(flat)) {
    for (size_t i = 1; i + 1 < corners.size(); ++i) put(0, i, i + 1);
    return true;
  }
  if (corners.size() > kMaxConcaveCorners) return false;
  EarCutter(flat).cut(put);
  return true;
}

}  // namespace

std::string triangulate_polygons(std::span<const Vec3f> positions, const PolygonList& polygons,
                                 std::vector<uint32_t>* indices, uint64_t* bad) {
  const size_t count = polygons.sizes.size();
  std::vector<uint64_t> first_corner(count + 1, 0), first_triangle(count + 1, 0);
  for (size_t i = 0; i < count; ++i) {
    const uint32_t size = polygons.sizes[i];
    first_corner[i + 1] = first_corner[i] + size;
    first_triangle[i + 1] = first_triangle[i] + (size < 3 ? 0 : size - 2);
  }
  indices->resize(3 * first_triangle[count]);
  std::atomic<uint64_t> first_bad{UINT64_MAX};
  parallel_for_range(
      "triangulate", static_cast<int64_t>(count), 4096, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
          if (polygons.sizes[i] < 3) continue;
          const auto corners = std::span<const uint32_t>(polygons.corners)
                                   .subspan(first_corner[i], polygons.sizes[i]);
          if (triangulate(positions, corners, indices->data() + 3 * first_triangle[i])) continue;
          uint64_t known = first_bad.load();
          while (i < known && !first_bad.compare_exchange_weak(known, i)) {
          }
        }
      });
  *bad = first_bad;
  if (*bad == UINT64_MAX) return {};
  return fmt::format("is concave and has {} corners; the limit is {}", polygons.sizes[*bad],
                     kMaxConcaveCorners);
}

}  // namespace gloam

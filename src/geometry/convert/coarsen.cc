#include "geometry/convert/coarsen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "geometry/convert/closest_point.h"
#include "geometry/convert/mass.h"

namespace gloam {
namespace {

constexpr double kFinestResolution = 256;  // cells along the longest side that are tried first
constexpr double kMinFacingCosine = 0.5;   // least cosine between vertices that face one way
constexpr double kMeanWeight = 1e-3;  // weight of the cell's mean beside the planes, of their own

// Quadric of the squared distance to planes, about a point nearby: p^T A p - 2 b p, and the mean of
// the vertices.
struct Quadric {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  Vec3d b, sum;
  double count = 0;
};

// Solves (A + lean) p = b + lean mean by Cramer's rule: symmetric and, thanks to the lean, regular.
Vec3d lowest(const Quadric& q, double half_cell) {
  const Vec3d mean = q.sum * (1 / q.count);
  const double lean = kMeanWeight * (q.xx + q.yy + q.zz);
  if (!(lean > 0)) return mean;
  const Vec3d x{q.xx + lean, q.xy, q.xz}, y{q.xy, q.yy + lean, q.yz}, z{q.xz, q.yz, q.zz + lean};
  const double det = dot(x, cross(y, z));
  const Vec3d b = q.b + mean * lean;
  const Vec3d p{dot(b, cross(y, z)) / det, dot(x, cross(b, z)) / det, dot(x, cross(y, b)) / det};
  const Vec3d away = p - mean;
  const double far = std::sqrt(length_squared(away));
  if (!(far > half_cell)) return p;
  return mean + away * (half_cell / far);
}

class Clustering {
 public:
  explicit Clustering(const TriangleMesh& mesh) : mesh_(mesh), facing_(mesh.positions.size()) {
    low_ = high_ = mesh.positions[mesh.indices[0]];
    for (size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Triangle3d c = triangle_of(mesh, t);
      const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
      for (size_t k = 3 * t; k < 3 * t + 3; ++k) {
        facing_[mesh.indices[k]] += n;
        const Vec3f p = mesh.positions[mesh.indices[k]];
        low_ = {min(low_.x, p.x), min(low_.y, p.y), min(low_.z, p.z)};
        high_ = {max(high_.x, p.x), max(high_.y, p.y), max(high_.z, p.z)};
      }
    }
  }

  TriangleMesh with_cells(double cells) {
    cell_ = double{max_component(high_ - low_)} / cells;
    assign();
    TriangleMesh out;
    for (size_t t = 0; t + 2 < mesh_.indices.size(); t += 3) {
      const std::array<uint32_t, 3> c = corners(t);
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      out.indices.insert(out.indices.end(), c.begin(), c.end());
    }
    return out;
  }

  // Positions of the clusters of the last with_cells().
  std::vector<Vec3f> positions() const {
    std::vector<Quadric> quadrics(count_);
    for (size_t v = 0; v < cluster_.size(); ++v) {
      if (cluster_[v] == UINT32_MAX) continue;
      Quadric& q = quadrics[cluster_[v]];
      q.sum += wide(mesh_.positions[v]) - wide(low_);
      q.count += 1;
    }
    for (size_t t = 0; t < mesh_.triangle_count(); ++t) add_plane(t, &quadrics);
    std::vector<Vec3f> out;
    for (const Quadric& q : quadrics) {
      const Vec3d p = lowest(q, cell_ / 2) + wide(low_);
      out.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    return out;
  }

 private:
  void assign() {
    // Clusters of a cell begun so far, each with the direction that its first vertex faces. Octants
    // of the direction would not do: a slightly rough wall along the axes has four of them
    // everywhere.
    struct Begun {
      Vec3d facing;
      uint32_t cluster;
    };
    std::unordered_map<uint64_t, std::vector<Begun>> known;  // looked up only, never walked
    cluster_.assign(mesh_.positions.size(), UINT32_MAX);
    count_ = 0;
    for (const uint32_t v : mesh_.indices) {
      if (cluster_[v] != UINT32_MAX) continue;
      const Vec3d at = (wide(mesh_.positions[v]) - wide(low_)) * (1 / cell_);
      const auto step = [](double x) { return static_cast<uint64_t>(std::max(x, 0.0)) & 0xFFFFF; };
      const double size = length_of(facing_[v]);
      const Vec3d n = size > 0 ? facing_[v] * (1 / size) : Vec3d{};
      std::vector<Begun>& begun = known[step(at.x) << 40 | step(at.y) << 20 | step(at.z)];
      const auto alike = std::find_if(begun.begin(), begun.end(), [&](const Begun& b) {
        return dot(b.facing, n) > kMinFacingCosine;
      });
      if (alike != begun.end()) {
        cluster_[v] = alike->cluster;
      } else {
        cluster_[v] = static_cast<uint32_t>(count_++);
        begun.push_back({n, cluster_[v]});
      }
    }
  }

  std::array<uint32_t, 3> corners(size_t first_index) const {
    const uint32_t* i = &mesh_.indices[first_index];
    return {cluster_[i[0]], cluster_[i[1]], cluster_[i[2]]};
  }

  // Weighted by the triangle's area squared, to each of its clusters once.
  void add_plane(size_t triangle, std::vector<Quadric>* quadrics) const {
    const Triangle3d c = triangle_of(mesh_, triangle);
    const Vec3d n = cross(c[1] - c[0], c[2] - c[0]) * (1 / (cell_ * cell_));
    const double d = dot(n, c[0] - wide(low_));
    const std::array<uint32_t, 3> to = corners(3 * triangle);
    for (size_t k = 0; k < 3; ++k) {
      if (std::find(to.begin(), to.begin() + static_cast<int>(k), to[k]) !=
          to.begin() + static_cast<int>(k))
        continue;
      Quadric& q = (*quadrics)[to[k]];
      q.xx += n.x * n.x, q.yy += n.y * n.y, q.zz += n.z * n.z;
      q.xy += n.x * n.y, q.xz += n.x * n.z, q.yz += n.y * n.z;
      q.b += n * d;
    }
  }

  const TriangleMesh& mesh_;
  std::vector<Vec3d> facing_;  // normals of vertices, not normalised
  Vec3f low_, high_;
  double cell_ = 0;  // [m]
  std::vector<uint32_t> cluster_;
  size_t count_ = 0;
};

}  // namespace

TriangleMesh coarsened(const TriangleMesh& welded, size_t triangles) {
  if (welded.triangle_count() <= triangles) return welded;
  Clustering clustering(welded);
  for (double cells = kFinestResolution;;) {
    TriangleMesh out = clustering.with_cells(cells);
    if (out.triangle_count() <= triangles || cells < 2) {
      out.positions = clustering.positions();
      return out;
    }
    const double over = static_cast<double>(out.triangle_count()) / static_cast<double>(triangles);
    cells *= 0.97 / std::sqrt(over);
  }
}

}  // namespace gloam

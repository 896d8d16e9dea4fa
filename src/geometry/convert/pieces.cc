#include "geometry/convert/pieces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/convert/hull.h"
#include "geometry/convert/mass.h"

namespace gloam {
namespace {

/// Sets of vertices that triangles connect.
class VertexSets {
 public:
  explicit VertexSets(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  uint32_t root(uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void join(uint32_t a, uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<uint32_t> parent_;
};

/// Adds a triangle of `from` to meshes of their own vertices.
class PieceBuilder {
 public:
  explicit PieceBuilder(const TriangleMesh& from) : from_(from) {}
  void add(size_t triangle) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = from_.indices[3 * triangle + k];
      const auto [own, is_new] =
          numbers_.emplace(vertex, static_cast<uint32_t>(out_.positions.size()));
      if (is_new) out_.positions.push_back(from_.positions[vertex]);
      out_.indices.push_back(own->second);
    }
  }
  TriangleMesh take() { return std::move(out_); }

 private:
  const TriangleMesh& from_;
  std::map<uint32_t, uint32_t> numbers_;
  TriangleMesh out_;
};

void append(const TriangleMesh& piece, TriangleMesh* to) {
  const auto first = static_cast<uint32_t>(to->positions.size());
  to->positions.insert(to->positions.end(), piece.positions.begin(), piece.positions.end());
  for (const uint32_t index : piece.indices) to->indices.push_back(first + index);
}

double volume_of(const TriangleMesh& mesh) { return mass_properties(mesh).volume; }

TriangleMesh hull_of(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<Vec3f> points = a.positions;
  points.insert(points.end(), b.positions.begin(), b.positions.end());
  return convex_hull(points);
}

}  // namespace

Pieces pieces_of(const TriangleMesh& welded, double concavity) {
  VertexSets sets(welded.positions.size());
  for (size_t t = 0; t + 2 < welded.indices.size(); t += 3)
    for (size_t k = 1; k < 3; ++k) sets.join(welded.indices[t], welded.indices[t + k]);
  std::map<uint32_t, size_t> places;
  std::vector<PieceBuilder> builders;
  for (size_t t = 0; t < welded.triangle_count(); ++t) {
    const auto [place, is_new] = places.emplace(sets.root(welded.indices[3 * t]), builders.size());
    if (is_new) builders.emplace_back(welded);
    builders[place->second].add(t);
  }
  Pieces out;
  for (PieceBuilder& builder : builders) {
    TriangleMesh piece = builder.take();
    const TriangleMesh hull = convex_hull(piece.positions);
    const double volume = volume_of(piece);
    const bool is_closed = count_edges(piece).is_closed();
    if (is_closed && volume < 0) return {{}, {welded}, {}};  // a hollow in another piece
    if (is_closed && !hull.indices.empty() && volume >= (1 - concavity) * volume_of(hull))
      out.convex.push_back(hull);
    else if (is_closed)
      out.closed.push_back(std::move(piece));
    else
      append(piece, &out.open);
  }
  return out;
}

std::vector<TriangleMesh> merge_hulls(std::vector<TriangleMesh> hulls, size_t most) {
  const size_t count = hulls.size();
  std::vector<double> volumes(count);
  for (size_t i = 0; i < count; ++i) volumes[i] = volume_of(hulls[i]);
  const double never = std::numeric_limits<double>::infinity();
  std::vector<double> costs(count * count, never);  // of (i, k), i < k
  const auto weigh = [&](size_t i, size_t k) {
    costs[i * count + k] = volume_of(hull_of(hulls[i], hulls[k])) - volumes[i] - volumes[k];
  };
  for (size_t i = 0; i < count; ++i)
    for (size_t k = i + 1; k < count; ++k) weigh(i, k);
  std::vector<bool> is_gone(count);
  for (size_t left = count; left > std::max<size_t>(most, 1); --left) {
    const auto cheapest =
        static_cast<size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    const size_t i = cheapest / count, k = cheapest % count;
    hulls[i] = hull_of(hulls[i], hulls[k]);
    volumes[i] = volume_of(hulls[i]);
    is_gone[k] = true;
    for (size_t other = 0; other < count; ++other) {
      costs[std::min(k, other) * count + std::max(k, other)] = never;
      if (other != i && !is_gone[other]) weigh(std::min(i, other), std::max(i, other));
    }
  }
  std::vector<TriangleMesh> out;
  for (size_t i = 0; i < count; ++i)
    if (!is_gone[i]) out.push_back(std::move(hulls[i]));
  return out;
}

}  // namespace gloam

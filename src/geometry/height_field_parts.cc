#include "geometry/height_field_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

constexpr double kGroundBase = 1;  // [m]
constexpr uint64_t kErrorSeed = 1;

/// Layer of the lowest floor at a sample; -1 = none.
int lowest_layer(const Floors& floors, size_t sample) {
  int layer = floors.layers - 1;
  while (layer >= 0 && std::isnan(floors.at(layer, sample))) --layer;
  return layer;
}

/// Fills NaN samples; returns their number.
int64_t fill(const HeightGrid& grid, std::vector<float>* z) {
  const auto around = [&](size_t sample, auto&& visit) {
    const int c = static_cast<int>(sample % static_cast<size_t>(grid.columns));
    const int r = static_cast<int>(sample / static_cast<size_t>(grid.columns));
    for (int y = std::max(r - 1, 0); y <= std::min(r + 1, grid.rows - 1); ++y)
      for (int x = std::max(c - 1, 0); x <= std::min(c + 1, grid.columns - 1); ++x)
        visit(static_cast<size_t>(y) * static_cast<size_t>(grid.columns) + static_cast<size_t>(x));
  };
  std::vector<size_t> ring, next;
  std::vector<bool> is_listed(z->size());
  const auto list_missing_around = [&](size_t sample) {
    around(sample, [&](size_t other) {
      if (!std::isnan((*z)[other]) || is_listed[other]) return;
      is_listed[other] = true;
      next.push_back(other);
    });
  };
  for (size_t i = 0; i < z->size(); ++i)
    if (!std::isnan((*z)[i])) list_missing_around(i);
  int64_t filled = 0;
  std::vector<float> values;
  while (!next.empty()) {
    ring.swap(next);
    next.clear();
    values.clear();
    for (const size_t sample : ring) {
      float lowest = INFINITY;
      around(sample, [&](size_t other) { lowest = min((*z)[other], lowest); });  // NaN: no
      values.push_back(lowest);
    }
    for (size_t i = 0; i < ring.size(); ++i) (*z)[ring[i]] = values[i];
    for (const size_t sample : ring) list_missing_around(sample);
    filled += static_cast<int64_t>(ring.size());
  }
  return filled;
}

/// Finds the slabs: quads of four floors that hang together, then rectangles of quads.
class Slabs {
 public:
  explicit Slabs(const Floors& floors)
      : floors_(floors),
        columns_(static_cast<size_t>(floors.grid.columns)),
        used_(floors.z.size()),
        reach_{std::max(kFloorClearance, 2 * floors.grid.step[0]),
               std::max(kFloorClearance, 2 * floors.grid.step[1])} {}

  Result<std::vector<HeightField>> find() {
    std::vector<HeightField> slabs;
    for (size_t sample = 0; sample < floors_.grid.size(); ++sample) {
      for (int layer = 0; layer < floors_.layers; ++layer) {
        const Node node{layer, sample};
        if (!is_free_quad(node)) continue;
        if (slabs.size() == kMostSlabs) {
          return Error{
              ErrorKind::kInput,
              fmt::format("the floors above the ground consist of more than {} pieces", kMostSlabs),
              {},
              "use a coarser 'resolution', fewer 'layers' or a smaller region"};
        }
        slabs.push_back(grow(node));
      }
    }
    return slabs;
  }

 private:
  /// One floor at one sample; layer -1 = none.
  struct Node {
    int layer = -1;
    size_t sample = 0;
    friend bool operator==(const Node&, const Node&) = default;
  };
  struct Quad {
    Node corner[4];  // low, right, up, across; layer -1 where it does not hang together
  };
  /// Heights that a piece has: a solid takes the air under it away.
  struct Extent {
    double low = INFINITY, high_over_floor = -INFINITY;
    bool fits() const { return high_over_floor - low <= kMostLostAir; }
  };

  float z(Node n) const { return floors_.at(n.layer, n.sample); }
  bool is_ground(Node n) const { return n.layer == lowest_layer(floors_, n.sample); }
  size_t index(Node n) const {
    return static_cast<size_t>(n.layer) * floors_.grid.size() + n.sample;
  }

  Node nearest(Node from, size_t sample, double reach) const {
    Node best;
    for (int layer = 0; layer < floors_.layers; ++layer) {
      const double distance = std::abs(floors_.at(layer, sample) - z(from));
      if (!(distance <= reach)) continue;  // NaN too
      reach = distance;
      best = {layer, sample};
    }
    return best;
  }
  Node right(Node n) const {
    if (n.layer < 0 || (n.sample + 1) % columns_ == 0) return {};
    return nearest(n, n.sample + 1, reach_[0]);
  }
  Node up(Node n) const {
    if (n.layer < 0 || n.sample + columns_ >= floors_.grid.size()) return {};
    return nearest(n, n.sample + columns_, reach_[1]);
  }
  Quad quad(Node n) const {
    Quad q{{n, right(n), up(n), {}}};
    q.corner[3] = right(q.corner[2]);
    if (q.corner[3] != up(q.corner[1])) q.corner[3] = {};
    return q;
  }
  bool is_free_quad(Node n) const {
    if (n.layer < 0 || std::isnan(z(n)) || used_[index(n)]) return false;
    const Quad q = quad(n);
    if (q.corner[3].layer < 0) return false;
    return !std::all_of(q.corner, q.corner + 4, [&](Node c) { return is_ground(c); });
  }
  void take(Node n, Extent* extent) const {
    for (const Node& c : quad(n).corner) {
      extent->low = std::min(extent->low, double{z(c)});
      if (!is_ground(c)) extent->high_over_floor = std::max(extent->high_over_floor, double{z(c)});
    }
  }

  HeightField grow(Node first) {
    Extent extent;
    take(first, &extent);
    std::vector<Node> row = {first};
    for (;;) {
      const Node n = right(row.back());
      if (!is_free_quad(n)) break;
      Extent wider = extent;
      take(n, &wider);
      if (!wider.fits()) break;
      extent = wider;
      row.push_back(n);
    }
    std::vector<std::vector<Node>> rows = {row};
    for (;;) {
      Extent wider = extent;
      for (Node& n : row) n = up(n);
      const bool is_free = std::all_of(row.begin(), row.end(), [&](Node n) {
        if (!is_free_quad(n)) return false;
        take(n, &wider);
        return wider.fits();
      });
      if (!is_free) break;
      extent = wider;
      rows.push_back(row);
    }
    for (const std::vector<Node>& nodes : rows)
      for (const Node& n : nodes) used_[index(n)] = true;
    return field_of(rows);
  }

  HeightField field_of(const std::vector<std::vector<Node>>& rows) const {
    HeightField field;
    const HeightGrid& grid = floors_.grid;
    field.column = static_cast<int>(rows[0][0].sample % columns_);
    field.row = static_cast<int>(rows[0][0].sample / columns_);
    field.grid = {
        {grid.low[0] + field.column * grid.step[0], grid.low[1] + field.row * grid.step[1]},
        grid.step,
        static_cast<int>(rows[0].size()) + 1,
        static_cast<int>(rows.size()) + 1};
    field.base = kSlabBase;
    const auto add_row = [&](const std::vector<Node>& nodes, int low, int high) {
      for (const Node& n : nodes) field.z.push_back(z(quad(n).corner[low]));
      field.z.push_back(z(quad(nodes.back()).corner[high]));
    };
    for (const std::vector<Node>& nodes : rows) add_row(nodes, 0, 1);
    add_row(rows.back(), 2, 3);
    return field;
  }

  const Floors& floors_;
  size_t columns_;
  std::vector<bool> used_;  // flags of quads, by the node at their low corner
  std::array<double, 2> reach_;
};

}  // namespace

double HeightField::height(int c, int r, double u, double v) const {
  const double low = at(c, r), high = at(c + 1, r + 1);
  const double side = u > v ? at(c + 1, r) : at(c, r + 1);
  return u > v ? low + u * (side - low) + v * (high - side)
               : low + v * (side - low) + u * (high - side);
}

Result<HeightField> ground_of(const Floors& floors) {
  HeightField field;
  field.grid = floors.grid;
  field.base = kGroundBase;
  bool is_any = false;
  for (size_t i = 0; i < floors.grid.size(); ++i) {
    const int layer = lowest_layer(floors, i);
    field.z.push_back(floors.at(std::max(layer, 0), i));
    is_any |= layer >= 0;
  }
  if (!is_any) return Error{ErrorKind::kInput, "no sample of the region has a surface below it"};
  field.filled = fill(field.grid, &field.z);
  return field;
}

Result<std::vector<HeightField>> slabs_of(const Floors& floors) {
  if (floors.layers == 1) return std::vector<HeightField>();
  return Slabs(floors).find();
}

Result<HeightError> height_error(std::span<const PlacedMesh> meshes, const Floors& floors,
                                 std::span<const HeightField> fields) {
  HeightGrid cells = floors.grid;
  --cells.columns, --cells.rows;
  GLOAM_TRY(const Floors source, sample_floors(meshes, cells, floors.layers, kErrorSeed));
  // Cells count only if all of their corners met something: the others' heights are made up.
  const auto is_met = [&](int column, int row) {
    const auto corner = static_cast<size_t>(row) * static_cast<size_t>(floors.grid.columns) +
                        static_cast<size_t>(column);
    const auto next_row = static_cast<size_t>(floors.grid.columns);
    return !std::isnan(floors.at(0, corner)) && !std::isnan(floors.at(0, corner + 1)) &&
           !std::isnan(floors.at(0, corner + next_row)) &&
           !std::isnan(floors.at(0, corner + next_row + 1));
  };
  std::vector<double> nearest(source.z.size(), INFINITY);
  for (const HeightField& field : fields) {
    for (int r = 0; r + 1 < field.grid.rows; ++r) {
      for (int c = 0; c + 1 < field.grid.columns; ++c) {
        const int column = field.column + c, row = field.row + r;
        if (!is_met(column, row)) continue;
        const std::array<double, 2> at = place_in_cell(kErrorSeed, column, row);
        const double height = field.height(c, r, at[0], at[1]);
        for (int layer = 0; layer < floors.layers; ++layer) {
          const size_t i = static_cast<size_t>(layer) * cells.size() +
                           static_cast<size_t>(row) * static_cast<size_t>(cells.columns) +
                           static_cast<size_t>(column);
          const double distance = std::abs(height - source.z[i]);
          if (distance < nearest[i]) nearest[i] = distance;
        }
      }
    }
  }
  std::erase_if(nearest, [](double d) { return std::isinf(d); });  // nothing is there
  HeightError error;
  error.points = static_cast<int64_t>(nearest.size());
  if (nearest.empty()) return error;
  for (const double d : nearest) error.mean += d / static_cast<double>(nearest.size());
  const auto p95 = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() * 95 / 100);
  std::nth_element(nearest.begin(), p95, nearest.end());
  error.p95 = *p95;
  error.most = *std::max_element(p95, nearest.end());
  return error;
}

}  // namespace gloam

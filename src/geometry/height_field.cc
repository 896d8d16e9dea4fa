#include "geometry/height_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "base/rng.h"

namespace gloam {
namespace {

using Vec3d = Vec3Of<double>;
constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();
constexpr double kSameSurface = 1e-3;  // [m] two triangles that meet in an edge under a sample
constexpr size_t kMostSurfaces = 64;   // over one another, on average over a band of rows
constexpr double kMaxMeanOverdraw =
    1024;                            // the same over the grid, where the highest alone is kept
constexpr int kBands = 64;           // bands of rows, one task each
constexpr int kTriangleGroups = 16;  // groups of triangles, one task each

Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }

/// A triangle over the grid: x in columns, y in rows, z in metres.
struct GridTriangle {
  Vec3d p[3];
  double area = 0;  // seen from above [cells]
  bool faces_up = false;
  double low_y() const { return std::min({p[0].y, p[1].y, p[2].y}); }
  double high_y() const { return std::max({p[0].y, p[1].y, p[2].y}); }
};

/// All triangles of all meshes, by one number. A vertex is put in its place anew for each of its
/// triangles: always to the same bits, and cheaper than keeping it.
class GridTriangles {
 public:
  GridTriangles(std::span<const PlacedMesh> meshes, const HeightGrid& grid) : meshes_(meshes) {
    for (const PlacedMesh& mesh : meshes) {
      first_.push_back(count_);
      count_ += mesh.mesh->triangle_count();
      AffineOf<double> X = mesh.X_WI;
      is_mirrored_.push_back(dot(X.x, cross(X.y, X.z)) < 0);
      X.p = X.p - Vec3d{grid.low[0], grid.low[1], 0};
      for (Vec3d* v : {&X.x, &X.y, &X.z, &X.p})
        *v = {v->x / grid.step[0], v->y / grid.step[1], v->z};
      X_GI_.push_back(X);
    }
  }
  size_t count() const { return count_; }

  GridTriangle operator[](size_t index) const {
    const auto next = std::upper_bound(first_.begin(), first_.end(), index);
    const auto m = static_cast<size_t>(next - first_.begin()) - 1;
    const TriangleMesh& mesh = *meshes_[m].mesh;
    const uint32_t* corner = &mesh.indices[3 * (index - first_[m])];
    GridTriangle t;
    for (int k = 0; k < 3; ++k)
      t.p[k] = transform_point(X_GI_[m], to_double(mesh.positions[corner[k]]));
    const double turn = (t.p[1].x - t.p[0].x) * (t.p[2].y - t.p[0].y) -
                        (t.p[1].y - t.p[0].y) * (t.p[2].x - t.p[0].x);
    t.area = std::abs(turn) / 2;
    t.faces_up = is_mirrored_[m] ? turn < 0 : turn > 0;
    return t;
  }

 private:
  std::span<const PlacedMesh> meshes_;
  std::vector<size_t> first_;  // triangle of each mesh
  std::vector<bool> is_mirrored_;
  std::vector<AffineOf<double>> X_GI_;  // into the grid
  size_t count_ = 0;
};

/// Part of a line along x at y inside of a triangle.
struct Span {
  double x0 = std::numeric_limits<double>::infinity(), z0 = 0;  // its ends, x0 <= x1
  double x1 = -std::numeric_limits<double>::infinity(), z1 = 0;

  void add(double x, double z) {
    if (x < x0 || (x == x0 && z > z0)) x0 = x, z0 = z;
    if (x > x1 || (x == x1 && z > z1)) x1 = x, z1 = z;
  }
  double height(double x) const {
    return x1 > x0 ? z0 + (z1 - z0) * ((x - x0) / (x1 - x0)) : std::max(z0, z1);
  }
};

/// The cut through an edge is worked out from its lower end, so that it has the same bits in both
/// triangles: their spans touch, and no sample falls between them.
Span cut(const GridTriangle& t, double y) {
  Span span;
  for (int k = 0; k < 3; ++k) {
    const Vec3d *a = &t.p[k], *b = &t.p[(k + 1) % 3];
    if (a->y == y) span.add(a->x, a->z);
    if (b->y < a->y) std::swap(a, b);
    if (!(a->y < y && y < b->y)) continue;
    const double part = (y - a->y) / (b->y - a->y);
    span.add(a->x + part * (b->x - a->x), a->z + part * (b->z - a->z));
  }
  return span;
}

/// Draws triangles into a band of rows; `emit(sample of the band, z, faces up)`.
class Band {
 public:
  Band(const HeightGrid& grid, int index, uint64_t seed)
      : grid_(grid), seed_(seed), begin_(row_of(grid, index)), end_(row_of(grid, index + 1)) {}
  static int row_of(const HeightGrid& grid, int band) {
    return static_cast<int>(int64_t{grid.rows} * band / kBands);
  }
  size_t first() const { return static_cast<size_t>(begin_) * static_cast<size_t>(grid_.columns); }
  size_t size() const {
    return static_cast<size_t>(end_ - begin_) * static_cast<size_t>(grid_.columns);
  }

  template <class Emit>
  void draw(const GridTriangle& t, Emit&& emit) const {
    const double low = t.low_y(), high = t.high_y();
    const double before = seed_ != 0 ? 1 : 0;  // samples lie up to a cell after their corner
    const int last = clamp_to(std::floor(high), begin_ - 1, end_ - 1);
    for (int row = clamp_to(std::ceil(low - before), begin_, end_); row <= last; ++row) {
      const double y = seed_ != 0 ? row + place_in_cell(seed_, -1, row)[1] : row;
      const Span span = cut(t, y);
      const int right = clamp_to(std::floor(span.x1), -1, grid_.columns - 1);
      for (int column = clamp_to(std::ceil(span.x0 - before), 0, grid_.columns); column <= right;
           ++column) {
        const double x = seed_ != 0 ? column + place_in_cell(seed_, column, row)[0] : column;
        if (x < span.x0 || x > span.x1) continue;
        const auto sample = static_cast<size_t>(row - begin_) * static_cast<size_t>(grid_.columns) +
                            static_cast<size_t>(column);
        emit(sample, static_cast<float>(span.height(x)), t.faces_up);
      }
    }
  }

 private:
  static int clamp_to(double value, int low, int high) {
    return value <= low ? low : value >= high ? high : static_cast<int>(value);
  }
  const HeightGrid& grid_;
  uint64_t seed_;
  int begin_, end_;  // rows
};

struct Hit {
  uint32_t sample;  // index in the band
  float z;
  bool faces_up;
};

/// Chooses floors from the hits of one sample, sorted from above: `out(layer, z)`.
template <class Out>
void choose_floors(std::span<const Hit> hits, int layers, Out&& out) {
  out(0, hits[0].z);
  double above = hits[0].z;
  size_t i = 0;
  for (int layer = 0; i < hits.size();) {
    const float z = hits[i].z;
    bool faces_up = false;
    for (; i < hits.size() && z - hits[i].z < kSameSurface; ++i) faces_up |= hits[i].faces_up;
    const bool is_floor = faces_up && above - double{z} >= kFloorClearance;
    above = z;
    if (!is_floor) continue;
    if (++layer == layers) return;
    out(layer, z);
  }
}

/// Triangles that reach into each band, by share and band; nothing when they would take too long.
std::vector<std::vector<uint32_t>> sort_into_bands(const GridTriangles& triangles,
                                                   const HeightGrid& grid) {
  std::vector<std::vector<uint32_t>> lists(static_cast<size_t>(kTriangleGroups) * kBands);
  std::vector<int> band_of(static_cast<size_t>(grid.rows));
  for (int band = 0; band < kBands; ++band)
    for (int row = Band::row_of(grid, band); row < Band::row_of(grid, band + 1); ++row)
      band_of[static_cast<size_t>(row)] = band;
  const size_t count = triangles.count();
  const auto samples = static_cast<double>(grid.size());
  const double most = kMaxMeanOverdraw * samples + kMaxMeanOverdraw * static_cast<double>(count);
  std::vector<double> drawn(kTriangleGroups);  // samples, about
  parallel_for("triangles into bands", kTriangleGroups, [&](int64_t share) {
    const auto k = static_cast<size_t>(share);
    for (size_t i = count * k / kTriangleGroups; i < count * (k + 1) / kTriangleGroups; ++i) {
      const GridTriangle t = triangles[i];
      // One row more, for samples that lie after their corner.
      const double low = std::max(std::ceil(t.low_y()) - 1, 0.0);
      const double high = std::min(std::floor(t.high_y()), double(grid.rows - 1));
      if (!(low <= high)) continue;
      drawn[k] += std::min(t.area, samples) + high - low;
      if (drawn[k] > most) return;
      const int last = band_of[static_cast<size_t>(high)];
      for (int band = band_of[static_cast<size_t>(low)]; band <= last; ++band)
        lists[k * kBands + static_cast<size_t>(band)].push_back(static_cast<uint32_t>(i));
    }
  });
  double sum = 0;
  for (const double share : drawn) sum += share;
  if (sum > most) lists.clear();
  return lists;
}

}  // namespace

Result<HeightGrid> make_height_grid(const std::array<double, 2>& low,
                                    const std::array<double, 2>& high, double resolution,
                                    int layers) {
  HeightGrid grid;
  double count[2];
  for (size_t k = 0; k < 2; ++k) {
    const double extent = high[k] - low[k];
    if (!(extent > 0)) {
      return Error{ErrorKind::kInput, fmt::format("the region is empty: {} from {:.6g} to {:.6g} m",
                                                  "xy"[k], low[k], high[k])};
    }
    // A part in 1e9: 20 m in steps of 0.1 m are 200, not 201.
    count[k] = std::max(std::ceil(extent / resolution * (1 - 1e-9)), 1.0) + 1;
    grid.step[k] = extent / (count[k] - 1);
  }
  if (!(count[0] * count[1] * layers <= static_cast<double>(kMostHeightSamples))) {
    return Error{
        ErrorKind::kInput,
        fmt::format("{:.0f} x {:.0f} samples in {} layer{} exceed the limit of {}", count[0],
                    count[1], layers, layers == 1 ? "" : "s", kMostHeightSamples),
        {},
        "use a coarser 'resolution' or a smaller region"};
  }
  grid.low = low;
  grid.columns = static_cast<int>(count[0]);
  grid.rows = static_cast<int>(count[1]);
  return grid;
}

bool bounds_of(std::span<const PlacedMesh> meshes, Vec3d* low, Vec3d* high) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  *low = {kFar, kFar, kFar}, *high = {-kFar, -kFar, -kFar};
  for (const PlacedMesh& mesh : meshes) {
    for (const Vec3f& vertex : mesh.mesh->positions) {
      const Vec3d p = transform_point(mesh.X_WI, to_double(vertex));
      *low = {std::min(low->x, p.x), std::min(low->y, p.y), std::min(low->z, p.z)};
      *high = {std::max(high->x, p.x), std::max(high->y, p.y), std::max(high->z, p.z)};
    }
  }
  return low->x <= high->x;
}

std::array<double, 2> place_in_cell(uint64_t seed, int column, int row) {
  // All samples of a row share one y, drawn at column -1.
  constexpr uint32_t kStream = 0x68666c64;  // "hfld"
  const RandomStream stream{seed, kStream};
  const auto at = [&](int c) {
    return stream.uniform(static_cast<uint32_t>(row), static_cast<uint32_t>(c));
  };
  return {column < 0 ? 0 : at(column), at(-1)};
}

Result<Floors> sample_floors(std::span<const PlacedMesh> meshes, const HeightGrid& grid, int layers,
                             uint64_t seed) {
  const GridTriangles triangles(meshes, grid);
  if (triangles.count() > std::numeric_limits<uint32_t>::max())
    return Error{ErrorKind::kInput, "meshes with more than 4 billion triangles cannot be sampled"};
  const std::vector<std::vector<uint32_t>> lists = sort_into_bands(triangles, grid);
  if (lists.empty()) {
    return Error{ErrorKind::kInput,
                 fmt::format("more than {:.0f} surfaces lie above one another", kMaxMeanOverdraw)};
  }
  Floors floors{grid, layers, {}};
  floors.z.assign(grid.size() * static_cast<size_t>(layers), kNoHeight);
  std::atomic<bool> is_too_deep{false};
  parallel_for("sample height field", kBands, [&](int64_t index) {
    const Band band(grid, static_cast<int>(index), seed);
    const auto each_triangle = [&](auto&& emit) {
      for (int share = 0; share < kTriangleGroups; ++share)
        for (const uint32_t i : lists[static_cast<size_t>(share * kBands + index)])
          band.draw(triangles[i], emit);
    };
    float* top = floors.z.data() + band.first();
    if (layers == 1) {
      each_triangle([top](size_t sample, float z, bool) {
        if (!(top[sample] >= z)) top[sample] = z;  // also where it is NaN
      });
      return;
    }
    std::vector<Hit> hits;
    const size_t most = kMostSurfaces * band.size();
    each_triangle([&](size_t sample, float z, bool faces_up) {
      if (hits.size() < most)
        hits.push_back({static_cast<uint32_t>(sample), z, faces_up});
      else
        is_too_deep = true;
    });
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
      return a.sample != b.sample ? a.sample < b.sample : a.z > b.z;
    });
    for (size_t i = 0, end = 0; i < hits.size(); i = end) {
      while (end < hits.size() && hits[end].sample == hits[i].sample) ++end;
      choose_floors({&hits[i], end - i}, layers, [&](int layer, float z) {
        top[static_cast<size_t>(layer) * grid.size() + hits[i].sample] = z;
      });
    }
  });
  if (is_too_deep) {
    return Error{ErrorKind::kInput,
                 fmt::format("more than {} surfaces lie above one another", kMostSurfaces),
                 {},
                 "use layers = 1, or a mesh without interior surfaces"};
  }
  return floors;
}

}  // namespace gloam

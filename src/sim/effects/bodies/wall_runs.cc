#include "sim/effects/bodies/wall_runs.h"

#include <algorithm>
#include <cmath>

namespace gloam {
namespace {

int to_index(double x, int low, int high) {
  return static_cast<int>(std::clamp(x, double(low), double(high)));
}

}  // namespace

WallRuns::WallRuns(const GasGrid& grid, double sealed_gap)
    : grid_(grid),
      n_{grid.nx, grid.ny, grid.nz},
      grow_(std::max(sealed_gap, 0.0) / 2 / double{grid.voxel}) {
  const auto most = static_cast<size_t>(std::max({grid.nx, grid.ny, grid.nz}));
  lo_.resize(most);
  hi_.resize(most);
}

void WallRuns::append(const GridSolid& solid, std::vector<WallRun>* runs) {
  int first[3], last[3];  // cells whose centres are within the bounds
  for (int axis = 0; axis < 3; ++axis) {
    const double low = solid.low(axis, grow_), high = solid.high(axis, grow_);
    // Half a voxel more on either side: a face at the border has a centre beyond it.
    if (!(high >= -0.5) || !(low <= n_[axis] + 0.5)) return;
    first[axis] = to_index(std::ceil(low - 0.5), 0, n_[axis]);
    last[axis] = to_index(std::floor(high - 0.5), -1, n_[axis] - 1);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int axis_b = axis == 0 ? 1 : 0, axis_c = axis == 2 ? 1 : 2, n = n_[axis];
    const int b0 = first[axis_b], count = last[axis_b] - b0 + 1;
    if (count <= 0) continue;
    for (int c = first[axis_c]; c <= last[axis_c]; ++c) {
      const size_t row = runs->size();
      solid.inside(axis, b0, c, count, grow_, lo_.data(), hi_.data());
      for (int i = 0; i < count; ++i) {
        const double lo = lo_[static_cast<size_t>(i)], hi = hi_[static_cast<size_t>(i)];
        if (!(lo <= hi) || lo > n + 0.5 || hi < -0.5) continue;
        const int first_face = to_index(std::ceil(lo - 0.5), 0, n);
        runs->push_back({axis, b0 + i, c, first_face, to_index(std::floor(hi + 0.5), 0, n), 0, -1});
      }
      if (axis != 0 || runs->size() == row) continue;
      solid.inside(axis, b0, c, count, 0, lo_.data(), hi_.data());
      for (WallRun& run : std::span(*runs).subspan(row)) {
        const auto i = static_cast<size_t>(run.b - b0);
        if (!(lo_[i] <= hi_[i])) continue;
        run.first_cell = to_index(std::ceil(lo_[i] - 0.5), 0, n);
        run.last_cell = to_index(std::floor(hi_[i] - 0.5), -1, n - 1);
      }
    }
  }
}

size_t WallRuns::most_runs(double radius) const {
  size_t most = 0;
  double across[3];
  for (int axis = 0; axis < 3; ++axis)
    across[axis] = std::min(
        double(n_[axis]), 2 * (radius + 2 * kWallTolerance) / double{grid_.voxel} + 4 * grow_ + 2);
  for (int axis = 0; axis < 3; ++axis)
    most +=
        static_cast<size_t>(across[(axis + 1) % 3]) * static_cast<size_t>(across[(axis + 2) % 3]);
  return most;
}

// Cells are those of lines along x; what the other axes' lines say of them differs by rounding,
// so all faces of a cell come with it.
template <class OnFace, class OnCell>
void WallRuns::visit(const WallRun& run, OnFace&& on_face, OnCell&& on_cell) const {
  const auto nx = static_cast<size_t>(n_[0]), ny = static_cast<size_t>(n_[1]);
  const auto b = static_cast<size_t>(run.b), c = static_cast<size_t>(run.c);
  const auto u = [](int i) { return static_cast<size_t>(i); };
  if (run.axis == 1) {
    for (size_t j = u(run.first_face); j <= u(run.last_face); ++j)
      on_face(1, (c * (ny + 1) + j) * nx + b, b, j, c);
    return;
  }
  if (run.axis == 2) {
    for (size_t k = u(run.first_face); k <= u(run.last_face); ++k)
      on_face(2, (k * ny + c) * nx + b, b, c, k);
    return;
  }
  for (size_t i = u(run.first_face); i <= u(run.last_face); ++i)
    on_face(0, (c * ny + b) * (nx + 1) + i, i, b, c);
  if (run.first_cell > run.last_cell) return;
  for (size_t i = u(run.first_cell); i <= u(run.last_cell); ++i) on_cell((c * ny + b) * nx + i);
  for (size_t side = 0; side < 2; ++side) {
    for (size_t i = u(run.first_cell); i <= u(run.last_cell); ++i)
      on_face(1, (c * (ny + 1) + b + side) * nx + i, i, b + side, c);
    for (size_t i = u(run.first_cell); i <= u(run.last_cell); ++i)
      on_face(2, ((c + side) * ny + b) * nx + i, i, b, c + side);
  }
}

void WallRuns::close(std::span<const WallRun> runs, GasWalls* walls) const {
  for (const WallRun& run : runs) {
    visit(
        run, [&](int axis, size_t at, size_t, size_t, size_t) { walls->closed[axis][at] = 1; },
        [&](size_t cell) { walls->solid[cell] = 1; });
  }
}

// The velocity along an axis of a rigid body does not change along that axis: what flows in at one
// end of a line flows out at the other, to the last bit.
void WallRuns::close(std::span<const WallRun> runs, const RigidMotion& motion,
                     const GasWalls& still, GasWalls* walls) const {
  const double voxel = grid_.voxel;
  const auto velocity = [&](int axis, size_t i, size_t j, size_t k) {
    const double r[3] = {voxel * (double(i) + 0.5), voxel * (double(j) + 0.5),
                         voxel * (double(k) + 0.5)};
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    return static_cast<float>(motion.v[axis] + motion.w[b] * r[c] - motion.w[c] * r[b]);
  };
  for (const WallRun& run : runs) {
    visit(
        run,
        [&](int axis, size_t at, size_t i, size_t j, size_t k) {
          walls->closed[axis][at] = 1;
          if (!still.closed[axis][at]) walls->velocity[axis][at] = velocity(axis, i, j, k);
        },
        [&](size_t cell) { walls->solid[cell] = 1; });
  }
}

void WallRuns::restore(std::span<const WallRun> runs, const GasWalls& still,
                       GasWalls* walls) const {
  for (const WallRun& run : runs) {
    visit(
        run,
        [&](int axis, size_t at, size_t, size_t, size_t) {
          walls->closed[axis][at] = still.closed[axis][at];
          walls->velocity[axis][at] = 0;
        },
        [&](size_t cell) { walls->solid[cell] = still.solid[cell]; });
  }
}

}  // namespace gloam

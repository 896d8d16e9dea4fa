// Moving walls: air in covered cells is pushed aside, freed cells are filled from their
// surroundings.

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"
#include "sim/effects/gas/gas_state.h"

namespace gloam {
namespace {

using gas::Shape;

/// Calls f(neighbour, face between) for the six neighbours of the cell at c.
template <class F>
void for_neighbours(const Shape& s, int c, F&& f) {
  for (int a = 0; a < 3; ++a) {
    const int stride = s.stride(a);
    f(c - stride, a, c);
    f(c + stride, a, c + stride);
  }
}

/// Walls of one grid, copied on several threads.
void copy_walls(const GasWalls& from, GasWalls* to) {
  parallel_for("gas", 7, [&from, to](int64_t n) {
    if (n < 3) {
      to->velocity[n] = from.velocity[n];
    } else if (n < 6) {
      to->closed[n - 3] = from.closed[n - 3];
    } else {
      to->solid = from.solid;
    }
  });
}

}  // namespace

void GasSolver::State::take_walls(const GasWalls& next) {
  GLOAM_CHECK(next.grid == grid && next.solid.size() == grid.cells(),
              "the walls belong to another grid");
  for (int a = 0; a < 3; ++a) {
    GLOAM_CHECK(next.closed[a].size() == grid.faces(a) && next.velocity[a].size() == grid.faces(a),
                "the walls belong to another grid");
  }
  filled.clear();
  freed.clear();
  for (int k = 0; k < shape.nz; ++k) {
    for (int j = 0; j < shape.ny; ++j) {
      const uint8_t *now = &next.solid[next.cell(0, j, k)], *was = &walls.solid[next.cell(0, j, k)];
      if (std::equal(now, now + shape.nx, was)) continue;
      for (int i = 0; i < shape.nx; ++i) {
        if (now[i] && !was[i]) filled.push_back(shape.at(i, j, k));
        if (was[i] && !now[i]) freed.push_back(shape.at(i, j, k));
      }
    }
  }
  if (card) {
    find_touched();
    card->download_cells(touched);
  }
  push_out(next);
  copy_walls(next, &walls);
  use_walls();
  fill_in();
  if (card) card->upload_cells(touched);
}

/// Cells that walls took or left, and those beside them, each once.
void GasSolver::State::find_touched() {
  touched.clear();
  for (const auto* cells : {&filled, &freed}) {
    for (const int c : *cells) {
      touched.push_back(c);
      for_neighbours(shape, c, [&](int n, int, int) { touched.push_back(n); });
    }
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
}

/// The solver's own layout of `walls`.
void GasSolver::State::use_walls() {
  openings.set(walls, pressure.multigrid().weights());
  // Side by side: spaces are found by one thread.
  parallel_for("gas", 2, [this](int64_t n) {
    if (n == 0) {
      openings.measure(pressure.open());
    } else {
      pressure.multigrid().update();
    }
  });
  if (card) {
    card->take_walls(walls);
    stale |= gas::kVelocityFields;
    return;
  }
  const gas::Faces<const float> open = pressure.open();
  for (int a = 0; a < 3; ++a) {
    const Shape& s = shape;
    const Shape faces = s.faces(a);
    gas::for_rows(faces, [&](int j, int k) {
      const float *own = walls.velocity[a].data() + walls.face(a, 0, j, k),
                  *w = open[a] + s.at(0, j, k);
      float* v = velocity[a].data() + s.at(0, j, k);
      GLOAM_IVDEP
      for (int i = 0; i < faces.nx; ++i) v[i] = w[i] > 0.0f ? v[i] : own[i];
    });
  }
}

/// The content of newly filled cells moves, from the innermost outwards, to neighbours nearer to
/// open ones, in even parts. Content from which no open cell can be reached stays as buried.
void GasSolver::State::push_out(const GasWalls& next) {
  const gas::Faces<const float> open = pressure.open();
  // Steps to the nearest open cell through faces that were open; 0 = open, -1 = not known.
  const auto is_in_box = [&](int c) {
    const int k = c / shape.sz - 1, j = c % shape.sz / shape.sy - 1, i = c % shape.sy - 1;
    return i >= 0 && i < shape.nx && j >= 0 && j < shape.ny && k >= 0 && k < shape.nz;
  };
  const auto in_next = [&](int c) {
    const int k = c / shape.sz - 1, j = c % shape.sz / shape.sy - 1, i = c % shape.sy - 1;
    return next.solid[next.cell(i, j, k)] != 0;
  };
  for (const int c : filled) depth[size_t(c)] = -1;
  order.clear();
  for (const int c : filled) {
    bool at_edge = false;
    for_neighbours(shape, c, [&](int n, int a, int face) {
      at_edge |= open[a][face] > 0.0f && is_in_box(n) && !in_next(n);
    });
    if (at_edge) depth[size_t(c)] = 1, order.push_back(c);
  }
  for (size_t head = 0; head < order.size(); ++head) {
    const int c = order[head];
    for_neighbours(shape, c, [&](int n, int a, int face) {
      if (open[a][face] == 0.0f || !is_in_box(n) || depth[size_t(n)] != -1) return;
      depth[size_t(n)] = depth[size_t(c)] + 1;
      order.push_back(n);
    });
  }
  for (size_t m = order.size(); m-- > 0;) {
    const int c = order[m], here = depth[size_t(c)];
    int count = 0;
    const auto for_nearer = [&](auto&& f) {
      for_neighbours(shape, c, [&](int n, int a, int face) {
        if (open[a][face] == 0.0f || !is_in_box(n) || depth[size_t(n)] != here - 1) return;
        if (here == 1 && in_next(n)) return;
        f(n);
      });
    };
    for_nearer([&](int) { ++count; });
    for (gas::Field& f : scalars) {
      const float part = f[size_t(c)] / float(count);
      for_nearer([&](int n) { f[size_t(n)] += part; });
      f[size_t(c)] = 0;
    }
  }
  for (const int c : filled) {
    if (depth[size_t(c)] == -1) {
      budget.heat_buried +=
          double(scalars[gas::kHeat][size_t(c)]) * cell_volume() * double(heat_unit());
      budget.smoke_buried += double(scalars[gas::kSmoke][size_t(c)]) * cell_volume();
      budget.fuel_buried += double(scalars[gas::kFuel][size_t(c)]) * cell_volume();
      for (gas::Field& f : scalars) f[size_t(c)] = 0;
    }
    burning[size_t(c)] = 0;
    depth[size_t(c)] = 0;
  }
}

/// A freed cell takes an even part of what its open neighbours hold.
void GasSolver::State::fill_in() {
  const gas::Faces<const float> open = pressure.open();
  for (const int c : freed) depth[size_t(c)] = 1;
  for (const int c : freed) {
    depth[size_t(c)] = 0;
    int count = 0;
    const auto for_open = [&](auto&& f) {
      for_neighbours(shape, c, [&](int n, int a, int face) {
        const int i = n % shape.sy - 1, j = n % shape.sz / shape.sy - 1, k = n / shape.sz - 1;
        const bool in_box =
            i >= 0 && i < shape.nx && j >= 0 && j < shape.ny && k >= 0 && k < shape.nz;
        if (in_box && open[a][face] > 0.0f && depth[size_t(n)] == 0) f(n);
      });
    };
    for_open([&](int) { ++count; });
    for (gas::Field& f : scalars) {
      float sum = 0;
      for_open([&](int n) {
        const float part = f[size_t(n)] / float(count + 1);
        f[size_t(n)] -= part;
        sum += part;
      });
      f[size_t(c)] = sum;
    }
  }
}

}  // namespace gloam

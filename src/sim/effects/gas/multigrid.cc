#include "sim/effects/gas/multigrid.h"

#include "sim/effects/gas/kernel/cycle.h"

namespace gloam::gas {
namespace {

constexpr int kCoarsestCells = 3;  ///< cells along an axis of a level that is not coarsened further

/// Distance of the centres of two cells between which face i lies.
float distance(const std::vector<float>& width, int i) {
  return 0.5f * (width[size_t(i)] + width[size_t(i) + 1]);
}

}  // namespace

Multigrid::Multigrid(const Shape& shape) : open_(size_t(shape.size()), 0) {
  for (Shape s = shape;;) {
    Level& level = levels_.emplace_back();
    // Walls may require that half of the cells along an axis stay unjoined: reserve memory for
    // that.
    level.shape = s;
    const size_t n = size_t(s.size());
    for (Field& w : level.weight) w.assign(n, 0.0f);
    for (Field* f : {&level.inverse, &level.x, &level.b, &level.scratch}) f->assign(n, 0.0f);
    for (int a = 0; a < 3; ++a) level.width[a].assign(size_t(s.n(a)) + 2, 1.0f);
    if (std::max({s.nx, s.ny, s.nz}) <= kCoarsestCells) break;
    s = Shape::of((s.nx + 1) / 2, (s.ny + 1) / 2, (s.nz + 1) / 2);
  }
  const size_t longest = size_t(std::max({shape.nx, shape.ny, shape.nz})) + 1;
  lost_.resize(longest);
  cost_.resize(longest * (longest + 1));
  choice_.resize(longest * (longest + 1));
}

Faces<float> Multigrid::weights() {
  Level& l = levels_[0];
  return {l.weight[0].data(), l.weight[1].data(), l.weight[2].data()};
}

PoissonView Multigrid::view(size_t level) const {
  const Level& l = levels_[level];
  return {l.shape, {l.weight[0].data(), l.weight[1].data(), l.weight[2].data()}, l.inverse.data()};
}

void Multigrid::update() {
  find_open_faces();
  invert(levels_[0]);
  for (size_t l = 1; l < levels_.size(); ++l) {
    for (int a = 0; a < 3; ++a) choose_cells(levels_[l - 1], a, &levels_[l].start[a]);
    coarsen(levels_[l - 1], levels_[l]);
    invert(levels_[l]);
  }
}

/// Closed faces on each plane of faces along the axis, among those between cells that have an open
/// face: their number less the sum of their weights over the largest weight.
void Multigrid::find_lost(const Level& fine, int axis) {
  const Shape& s = fine.shape;
  const int n = s.n(axis), stride = s.stride(axis);
  const float *weight = fine.weight[axis].data(), *inverse = fine.inverse.data();
  planes_.assign(size_t(s.nz) * size_t(n), {});
  for_slabs(s.nz, [&](int k) {
    Plane* planes = &planes_[size_t(k) * size_t(n)];
    // Sums side by side, along x.
    float count[kLongestRow] = {}, sum[kLongestRow] = {}, most[kLongestRow] = {};
    const auto add_up = [&](int plane) {
      for (int i = 0; i < s.nx; ++i) {
        Plane& to = planes[axis == 0 ? i : plane];
        to.count += count[i], to.sum += sum[i], to.most = max(to.most, most[i]);
        count[i] = sum[i] = most[i] = 0;
      }
    };
    for (int j = 0; j < s.ny; ++j) {
      const int begin = s.at(0, j, k), nx = s.nx;
      const float *w = weight + begin, *here = inverse + begin, *before = here - stride;
      GLOAM_IVDEP
      for (int i = 0; i < nx; ++i) {
        const float counts = (here[i] > 0.0f ? 1.0f : 0.0f) * (before[i] > 0.0f ? 1.0f : 0.0f);
        count[i] += counts;
        sum[i] += counts * w[i];
        most[i] = max(most[i], counts * w[i]);
      }
      if (axis == 1) add_up(j);
    }
    if (axis != 1) add_up(k);
  });
  for (int i = 1; i < n; ++i) {
    Plane all;
    double sum = 0;
    for (int k = 0; k < s.nz; ++k) {
      const Plane& p = planes_[size_t(k) * size_t(n) + size_t(i)];
      all.count += p.count, sum += double(p.sum), all.most = max(all.most, p.most);
    }
    lost_[size_t(i)] = all.most > 0 ? all.count - float(sum / double(all.most)) : all.count;
  }
}

/// The number of cells is fixed; which ones are joined is chosen so that little of what is closed
/// comes to lie inside (dynamic programming over the faces along the axis).
void Multigrid::choose_cells(const Level& fine, int axis, std::vector<int>* start) {
  const Shape& s = fine.shape;
  const int n = s.n(axis), coarse_n = (n + 1) / 2;
  find_lost(fine, axis);
  const float plane = float(s.nx) * float(s.ny) * float(s.nz) / float(n);
  const float uneven = 0.01f * plane;  // cost of a coarse cell that is not made of two
  // cost_[m][i]: of the first i cells joined to m.
  const auto at = [&](int m, int i) { return size_t(m) * size_t(n + 1) + size_t(i); };
  constexpr float kNever = 1e30f;
  for (int i = 0; i <= n; ++i) cost_[at(0, i)] = i == 0 ? 0 : kNever;
  for (int m = 1; m <= coarse_n; ++m) {
    for (int i = 0; i <= n; ++i) {
      float best = kNever;
      int size = 0;
      float inside = 0;
      for (int k = 1; k <= 3 && k <= i; ++k) {
        if (k > 1) inside += lost_[size_t(i - k + 1)];
        const float c = cost_[at(m - 1, i - k)] + inside + (k == 2 ? 0 : uneven);
        if (c < best) best = c, size = k;
      }
      cost_[at(m, i)] = best;
      choice_[at(m, i)] = size;
    }
  }
  start->resize(size_t(coarse_n) + 1);
  for (int m = coarse_n, i = n; m >= 0; --m) {
    (*start)[size_t(m)] = i;
    if (m > 0) i -= choice_[at(m, i)];
  }
}

void Multigrid::coarsen(const Level& fine, Level& coarse) {
  const Shape &s = coarse.shape, &t = fine.shape;
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < s.n(a); ++i) {
      float sum = 0;
      for (int f = coarse.start[a][size_t(i)]; f < coarse.start[a][size_t(i) + 1]; ++f) {
        sum += fine.width[a][size_t(f) + 1];
      }
      coarse.width[a][size_t(i) + 1] = sum;
    }
  }
  for (int a = 0; a < 3; ++a) {
    const float* from = fine.weight[a].data();
    float* to = coarse.weight[a].data();
    const Shape faces = s.faces(a);
    const auto first = [&](int axis, int i) { return coarse.start[axis][size_t(i)]; };
    const auto end = [&](int axis, int i) {
      return axis == a ? first(axis, i) + 1 : coarse.start[axis][size_t(i) + 1];
    };
    for_rows(faces, [&](int j, int k) {
      float row[kLongestRow + 1];  // sums of the finer faces along y and z
      const int n = t.faces(a).nx;
      std::fill_n(row, n, 0.0f);
      for (int z = first(2, k); z < end(2, k); ++z) {
        for (int y = first(1, j); y < end(1, j); ++y) {
          const float* more = from + t.at(0, y, z);
          GLOAM_IVDEP
          for (int x = 0; x < n; ++x) row[x] += more[x];
        }
      }
      for (int i = 0; i < faces.nx; ++i) {
        const int face = a == 0 ? i : (a == 1 ? j : k);
        const float share =
            distance(fine.width[a], first(a, face)) / distance(coarse.width[a], face);
        float sum = 0;
        for (int x = first(0, i); x < end(0, i); ++x) sum += row[x];
        to[s.at(i, j, k)] = sum * share;
      }
    });
  }
}

void Multigrid::find_open_faces() {
  const Level& level = levels_[0];
  const Faces<const float> weight = view(0).weight;
  uint8_t* open = open_.data();
  for_rows(level.shape, [&level, weight, open](int j, int k) {
    const Shape s = level.shape;
    const Faces<const float> w = weight;
    uint8_t* const to = open;
    const int begin = s.at(0, j, k), end = begin + s.nx;
    GLOAM_IVDEP
    for (int c = begin; c < end; ++c) to[c] = gas::open_faces(w, s, c);
  });
}

void Multigrid::invert(Level& level) {
  const Shape& s = level.shape;
  const float *x = level.weight[0].data(), *y = level.weight[1].data(), *z = level.weight[2].data();
  float* inverse = level.inverse.data();
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k);
    for (int c = begin; c < begin + s.nx; ++c) {
      const float sum = (x[c] + x[c + 1]) + (y[c] + y[c + s.sy]) + (z[c] + z[c + s.sz]);
      inverse[c] = sum > 0.0f ? 1.0f / sum : 0.0f;
    }
  });
}

/// Result of the step with kSmooth[0] from x = 0.
struct Multigrid::FirstStep {
  const float *inverse, *b;
  float operator[](int c) const { return kSmooth[0] * inverse[c] * b[c]; }
};

/// The rows of a cycle on the processor.
struct Multigrid::Cycle {
  Multigrid& grid;
  const float* finest_b;
  float* finest_x;
  int begun = -1;  // level that is still at begin()

  const float* b(size_t level) const {
    return level == 0 ? finest_b : grid.levels_[level].b.data();
  }
  float* x(size_t level) const { return level == 0 ? finest_x : grid.levels_[level].x.data(); }
  float* scratch(size_t level) const { return grid.levels_[level].scratch.data(); }

  // The first two steps are one pass: what the first makes, the second makes anew where it looks.
  void begin(int n) { begun = n; }
  void forth(int n, int step) {
    const size_t level = size_t(n);
    grid.smooth(level, b(level), static_cast<const float*>(x(level)), scratch(level),
                kSmooth[step]);
  }
  void back(int n, int step) {
    const size_t level = size_t(n);
    if (begun == n) {
      const FirstStep first{grid.levels_[level].inverse.data(), b(level)};
      grid.smooth(level, b(level), first, x(level), kSmooth[step]);
    } else {
      grid.smooth(level, b(level), static_cast<const float*>(scratch(level)), x(level),
                  kSmooth[step]);
    }
    begun = -1;
  }
  void restrict_residual(int n) {
    const size_t level = size_t(n);
    grid.restrict_residual(level, b(level), x(level));
  }
  void prolong(int n) { grid.prolong(size_t(n), x(size_t(n))); }
};

void Multigrid::precondition(const float* b, float* x) {
  Cycle cycle{*this, b, x};
  run_cycle(cycle, 0, levels(), true);
}

template <class From>
void Multigrid::smooth(size_t level, const float* b, From from, float* to, float damping) const {
  const PoissonView v = view(level);
  const uint8_t* open = open_.data();
  for_rows(v.shape, [&v, b, from, to, damping, open, level](int j, int k) {
    const PoissonView w = v;  // its own copy: the compiler need not look at it again for each cell
    const int begin = w.shape.at(0, j, k), end = begin + w.shape.nx;
    if (level == 0) {
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c)
        to[c] = relax(w, from, b, damping, apply_poisson(w.shape, open[c], from, c), c);
    } else {
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c) to[c] = relax(w, from, b, damping, c);
    }
  });
}

void Multigrid::restrict_residual(size_t level, const float* b, const float* x) {
  const PoissonView v = view(level);
  Level& coarse = levels_[level + 1];
  const Shape &s = v.shape, &t = coarse.shape;
  const uint8_t* open = open_.data();
  for_rows(t, [&, open](int j, int k) {
    float row[kLongestRow];  // residuals of the finer rows, added up
    for (int i = 0; i < s.nx; ++i) row[i] = 0;
    for (int z = coarse.start[2][size_t(k)]; z < coarse.start[2][size_t(k) + 1]; ++z) {
      for (int y = coarse.start[1][size_t(j)]; y < coarse.start[1][size_t(j) + 1]; ++y) {
        const int begin = s.at(0, y, z);
        if (level == 0) {
          GLOAM_IVDEP
          for (int i = 0; i < s.nx; ++i)
            row[i] += b[begin + i] - apply_poisson(s, open[begin + i], x, begin + i);
        } else {
          GLOAM_IVDEP
          for (int i = 0; i < s.nx; ++i) row[i] += b[begin + i] - apply_poisson(v, x, begin + i);
        }
      }
    }
    float* to = coarse.b.data() + t.at(0, j, k);
    const int* start = coarse.start[0].data();
    for (int i = 0; i < t.nx; ++i) {
      float sum = 0;
      for (int f = start[i]; f < start[i + 1]; ++f) sum += row[f];
      to[i] = sum;
    }
  });
}

void Multigrid::prolong(size_t level, float* x) {
  Level& coarse = levels_[level + 1];
  const float* inverse = levels_[level].inverse.data();
  const Shape &s = levels_[level].shape, &t = coarse.shape;
  for_rows(t, [&](int j, int k) {
    float row[kLongestRow];
    const float* from = coarse.x.data() + t.at(0, j, k);
    const int* start = coarse.start[0].data();
    for (int i = 0; i < t.nx; ++i) {
      for (int f = start[i]; f < start[i + 1]; ++f) row[f] = from[i];
    }
    for (int z = coarse.start[2][size_t(k)]; z < coarse.start[2][size_t(k) + 1]; ++z) {
      for (int y = coarse.start[1][size_t(j)]; y < coarse.start[1][size_t(j) + 1]; ++y) {
        const int begin = s.at(0, y, z);
        GLOAM_IVDEP
        for (int i = 0; i < s.nx; ++i) {
          // NOLINTNEXTLINE(clang-analyzer-*): the coarse cells together are all of the row
          x[begin + i] += inverse[begin + i] > 0.0f ? row[i] : 0.0f;
        }
      }
    }
  });
}

}  // namespace gloam::gas

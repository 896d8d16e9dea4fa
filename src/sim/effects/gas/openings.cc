#include "sim/effects/gas/openings.h"

namespace gloam::gas {

Openings::Openings(const Shape& s, const bool (&open)[6]) : shape(s) {
  std::copy(open, open + 6, side_open);
  const size_t n = size_t(s.size());
  for (auto* bytes : {&solid, &moving[0], &moving[1], &moving[2], &clearance, &near_, &spread_}) {
    bytes->assign(n, 0);
  }
  space.assign(n, 0);
  parent_.reserve(n / 4);
  number_.reserve(n / 4);
  count_.reserve(n / 4);
}

void Openings::set(const GasWalls& walls, const Faces<float>& open) {
  const Shape& s = shape;
  for_rows(s, [&](int j, int k) {
    std::copy_n(&walls.solid[walls.cell(0, j, k)], s.nx, &solid[size_t(s.at(0, j, k))]);
  });
  for (int a = 0; a < 3; ++a) {
    const Shape faces = s.faces(a);
    for_rows(faces, [&](int j, int k) {
      const uint8_t* closed = &walls.closed[a][walls.face(a, 0, j, k)];
      const float* velocity = &walls.velocity[a][walls.face(a, 0, j, k)];
      const int begin = s.at(0, j, k);
      float* const to = open[a] + begin;
      uint8_t* const moves = &moving[a][size_t(begin)];
      const int nx = faces.nx;
      GLOAM_IVDEP
      for (int i = 0; i < nx; ++i) to[i] = closed[i] ? 0.0f : 1.0f;
      GLOAM_IVDEP
      for (int i = 0; i < nx; ++i) moves[i] = uint8_t((closed[i] != 0) & (velocity[i] != 0.0f));
      if (a == 0) {
        if (!side_open[0]) to[0] = 0;
        if (!side_open[1]) to[s.nx] = 0;
      } else {
        const int at = a == 1 ? j : k;
        const bool side = (at == 0 && !side_open[2 * a]) || (at == s.n(a) && !side_open[2 * a + 1]);
        if (side) std::fill_n(to, s.nx, 0.0f);
      }
    });
  }
}

void Openings::measure(const Faces<const float>& open) {
  find_clearance(open);
  find_spaces(open);
}

void Openings::find_clearance(const Faces<const float>& open) {
  // Bytes may alias anything: what loops need lies in locals.
  const Shape s = shape;
  uint8_t* const clear = clearance.data();
  for_rows(s, [open, s, clear, near = near_.data()](int j, int k) {
    const Faces<const float> w = open;
    const int begin = s.at(0, j, k), end = begin + s.nx, sy = s.sy, sz = s.sz;
    uint8_t *const to_near = near, *const to_clear = clear;
    GLOAM_IVDEP
    for (int c = begin; c < end; ++c) {
      const float free = (w.x[c] * w.x[c + 1]) * (w.y[c] * w.y[c + sy]) * (w.z[c] * w.z[c + sz]);
      to_near[c] = uint8_t(free == 0.0f);
      to_clear[c] = uint8_t(kReach);
    }
  });
  // Spreads by one cell at a time, along one axis after the other.
  uint8_t *from = near_.data(), *to = spread_.data();
  for (int distance = 1; distance <= kReach + 1; ++distance) {
    // Cells near a wall by less than `distance` are clear by one less.
    for_rows(s, [s, from, clear, distance](int j, int k) {
      const int begin = s.at(0, j, k), end = begin + s.nx;
      const uint8_t *const near = from, most = uint8_t(distance > 1 ? distance - 2 : 0);
      uint8_t* const to_clear = clear;
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c) {
        const uint8_t bound = near[c] ? most : uint8_t(kReach);
        to_clear[c] = to_clear[c] < bound ? to_clear[c] : bound;
      }
    });
    for (int a = 0; a < 3 && distance <= kReach; ++a) {
      for_rows(s, [s, from, to, stride = s.stride(a)](int j, int k) {
        const int begin = s.at(0, j, k), end = begin + s.nx, step = stride;
        const uint8_t* const near = from;
        uint8_t* const spread = to;
        GLOAM_IVDEP
        for (int c = begin; c < end; ++c) {
          spread[c] = uint8_t(near[c] | near[c - step] | near[c + step]);
        }
      });
      std::swap(from, to);
    }
  }
}

int Openings::root(int run) {
  int* parent = parent_.data();
  while (parent[run] != run) run = parent[run] = parent[parent[run]];
  return run;
}

void Openings::join(int a, int b) {
  a = root(a), b = root(b);
  parent_[size_t(std::max(a, b))] = std::min(a, b);
}

/// Runs of open cells along x, joined where their cells touch through open faces; run 0 is outside.
void Openings::find_spaces(const Faces<const float>& open) {
  const Shape& s = shape;
  parent_.assign(1, 0);
  for (int k = 0; k < s.nz; ++k) {
    for (int j = 0; j < s.ny; ++j) {
      const int begin = s.at(0, j, k);
      int run = 0;
      for (int c = begin; c < begin + s.nx; ++c) {
        if (solid[size_t(c)]) {
          space[size_t(c)] = 0;
          continue;
        }
        if (c == begin || open.x[c] == 0.0f) {
          run = int(parent_.size());
          parent_.push_back(run);
        }
        space[size_t(c)] = run;
      }
      if (open.x[begin] != 0.0f && !solid[size_t(begin)]) join(0, space[size_t(begin)]);
      const int end = begin + s.nx;
      if (open.x[end] != 0.0f && !solid[size_t(end) - 1]) join(0, space[size_t(end) - 1]);
      const auto join_row = [&](const float* face, int stride, bool low, bool high) {
        int last_a = -1, last_b = -1;  // neighbours of one pair of runs are joined once
        for (int c = begin; c < end; ++c) {
          if (solid[size_t(c)]) continue;
          const int here = space[size_t(c)];
          if (face[c] != 0.0f && !(low && solid[size_t(c)])) {
            const int there = low ? 0 : space[size_t(c - stride)];
            if (here != last_a || there != last_b) join(here, there);
            last_a = here, last_b = there;
          }
          if (high && face[c + stride] != 0.0f) join(here, 0);
        }
      };
      join_row(open.y, s.sy, j == 0, j == s.ny - 1);
      join_row(open.z, s.sz, k == 0, k == s.nz - 1);
    }
  }
  // Enclosed spaces by number, in order of their first runs. Single cells need no pressure.
  const size_t runs = parent_.size();
  number_.assign(runs, 0);
  count_.assign(runs, 0);
  for (size_t r = 0; r < runs; ++r) parent_[r] = root(int(r));
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k);
    for (int c = begin; c < begin + s.nx; ++c) {
      space[size_t(c)] = parent_[size_t(space[size_t(c)])];
    }
  });
  bool any = false;
  for (size_t r = 1; r < runs; ++r) any |= parent_[r] != 0;
  enclosed = 0;
  if (!any) return;
  for (int k = 0; k < s.nz; ++k) {
    for (int j = 0; j < s.ny; ++j) {
      const int begin = s.at(0, j, k);
      for (int c = begin; c < begin + s.nx; ++c) ++count_[size_t(space[size_t(c)])];
    }
  }
  for (size_t r = 1; r < runs; ++r) {
    if (parent_[r] == int(r) && count_[r] > 1) number_[r] = ++enclosed;
  }
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k);
    for (int c = begin; c < begin + s.nx; ++c) {
      space[size_t(c)] = number_[size_t(space[size_t(c)])];
    }
  });
}

}  // namespace gloam::gas

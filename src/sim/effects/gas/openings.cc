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
    const Shape faces{s.nx + (a == 0), s.ny + (a == 1), s.nz + (a == 2), s.sy, s.sz};
    for_rows(faces, [&](int j, int k) {
      const uint8_t* closed = &walls.closed[a][walls.face(a, 0, j, k)];
      const float* velocity = &walls.velocity[a][walls.face(a, 0, j, k)];
      const int begin = s.at(0, j, k);
      float* to = open[a] + begin;
      for (int i = 0; i < faces.nx; ++i) {
        to[i] = closed[i] ? 0.0f : 1.0f;
        moving[a][size_t(begin + i)] = closed[i] && velocity[i] != 0.0f;
      }
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
  find_clearance(open.read());
  find_spaces(open.read());
}

void Openings::find_clearance(const Faces<const float>& open) {
  const Shape& s = shape;
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k);
#pragma GCC ivdep
    for (int c = begin; c < begin + s.nx; ++c) {
      const bool free = (open.x[c] * open.x[c + 1]) * (open.y[c] * open.y[c + s.sy]) *
                            (open.z[c] * open.z[c + s.sz]) >
                        0.0f;
      near_[size_t(c)] = !free;
      clearance[size_t(c)] = free ? kReach : 0;
    }
  });
  // Spreads by one cell at a time, along one axis after the other.
  uint8_t *from = near_.data(), *to = spread_.data();
  for (int distance = 1; distance <= kReach; ++distance) {
    for (int a = 0; a < 3; ++a) {
      const int stride = s.stride(a);
      for_rows(s, [&, from, to](int j, int k) {
        const int begin = s.at(0, j, k);
#pragma GCC ivdep
        for (int c = begin; c < begin + s.nx; ++c) {
          to[c] = uint8_t(from[c] | from[c - stride] | from[c + stride]);
        }
      });
      std::swap(from, to);
    }
    for_rows(s, [&, from](int j, int k) {
      const int begin = s.at(0, j, k);
      uint8_t* clear = clearance.data();
#pragma GCC ivdep
      for (int c = begin; c < begin + s.nx; ++c) {
        const uint8_t most = from[c] ? uint8_t(distance - 1) : uint8_t(kReach);
        clear[c] = std::min(clear[c], most);
      }
    });
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

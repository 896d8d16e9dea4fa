#include "sim/effects/gas/transport.h"

#include <bit>
#include <cmath>

namespace gloam::gas {
namespace {

constexpr int kBlock = 32;  ///< cells side by side in a sweep along y or z

/// Buffers of such a row while a sweep passes over it: ratios, and differences to the row before,
/// for each scalar; its air.
struct Row {
  float q[kScalars][kBlock], d[kScalars][kBlock], air[kBlock];
};

/// True if any of n cells, none below 0, holds something. It compares bits, which vectorizes.
bool holds_any(const float* field, int n) {
  uint32_t bits = 0;
  GLOAM_IVDEP
  for (int i = 0; i < n; ++i) bits |= std::bit_cast<uint32_t>(field[i]);
  return bits != 0;
}

/// air_left() of n cells from `begin`: the loop over axes outside of that over cells.
void find_air(const Shape& s, const Faces<const float>& courant, const int (&before)[2], int begin,
              int n, float* air) {
  std::fill_n(air, n, 1.0f);
  for (const int a : before) {
    if (a < 0) continue;
    const float *low = courant[a] + begin, *high = low + s.stride(a);
    GLOAM_IVDEP
    for (int i = 0; i < n; ++i) air[i] -= high[i] - low[i];
  }
}

}  // namespace

struct Transport::Sweep {
  int axis;
  int before[2];  ///< axes swept before in this substep, -1 = none
  const float* open;
  Field* scalars;
  Faces<const float> courant;
};

Transport::Transport(const Shape& shape) : shape_(shape) {
  for (Field& f : courant_) f.assign(size_t(shape.size()), 0.0f);
  row_most_.resize(size_t(shape.ny) * size_t(shape.nz));
  row_escaped_.resize(size_t(std::max(shape.ny, shape.nz)) * size_t(shape.nz) * kScalars);
}

float Transport::set_courant(const Faces<const float>& open, const Faces<const float>& velocity,
                             float scale) {
  const Shape& s = shape_;
  for (int a = 0; a < 3; ++a) {
    const Shape faces = s.faces(a);
    const float *w = open[a], *u = velocity[a];
    float* to = courant_[a].data();
    for_rows(faces, [&, w, u, to](int j, int k) {
      const int begin = s.at(0, j, k), end = begin + faces.nx;
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c) to[c] = w[c] * u[c] * scale;
    });
  }
  const float *x = courant_[0].data(), *y = courant_[1].data(), *z = courant_[2].data();
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k), end = begin + s.nx;
    float lanes[16] = {};
    const auto out = [&](int c) { return most_outflow(s, {x, y, z}, c); };
    int c = begin;
    for (; c + 16 <= end; c += 16) {
      for (int l = 0; l < 16; ++l) lanes[l] = max(lanes[l], out(c + l));
    }
    for (; c < end; ++c) lanes[0] = max(lanes[0], out(c));
    row_most_[size_t(k * s.ny + j)] = *std::max_element(lanes, lanes + 16);
  });
  return *std::max_element(row_most_.begin(), row_most_.end());
}

int Transport::carry(const Faces<const float>& open, const Faces<const float>& velocity,
                     Field* scalars, float voxel, float dt, uint64_t* parity,
                     double (&escaped)[kScalars]) {
  const float most = set_courant(open, velocity, dt / voxel);
  const int substeps = std::max(1, int(std::ceil(most / kMostOutflow)));
  if (substeps > 1) set_courant(open, velocity, dt / (voxel * float(substeps)));
  for (int n = 0; n < substeps; ++n) {
    const int* order = kOrders[(*parity)++ % 6];
    for (int m = 0; m < 3; ++m) {
      std::fill(row_escaped_.begin(), row_escaped_.end(), 0.0);
      const Sweep sweep{order[m],
                        {m > 0 ? order[0] : -1, m > 1 ? order[1] : -1},
                        open[order[m]],
                        scalars,
                        {courant_[0].data(), courant_[1].data(), courant_[2].data()}};
      if (sweep.axis == 0) {
        sweep_x(sweep);
      } else {
        sweep_across(sweep);
      }
      for (size_t i = 0; i < row_escaped_.size(); i += kScalars) {
        for (size_t f = 0; f < kScalars; ++f) escaped[f] += row_escaped_[i + f];
      }
    }
  }
  return substeps;
}

void Transport::sweep_x(const Sweep& sweep) {
  const Shape& s = shape_;
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k), n = s.nx;
    const float* courant = courant_[0].data() + begin;
    const float* open = sweep.open + begin;
    // Cell i lies at i + 2, with two ghosts of ambient air at both ends.
    float air[kLongestRow + 4], q[kLongestRow + 4], d[kLongestRow + 5], flux[kLongestRow + 1];
    air[0] = air[1] = air[n + 2] = air[n + 3] = 1.0f;
    bool is_known = false;
    for (size_t f = 0; f < kScalars; ++f) {
      float* field = sweep.scalars[f].data() + begin;
      if (!holds_any(field, n)) continue;
      if (!is_known) find_air(s, sweep.courant, sweep.before, begin, n, air + 2);
      is_known = true;
      q[0] = q[1] = q[n + 2] = q[n + 3] = 0.0f;
      GLOAM_IVDEP
      for (int i = 0; i < n; ++i) q[i + 2] = field[i] / air[i + 2];
      // d[i]: over the face before the cell at i.
      d[0] = d[1] = d[n + 3] = d[n + 4] = 0.0f;
      GLOAM_IVDEP
      for (int i = 0; i <= n; ++i) d[i + 2] = open[i] * (q[i + 2] - q[i + 1]);
      GLOAM_IVDEP
      for (int i = 0; i <= n; ++i) {
        flux[i] = face_flux(courant[i], q[i + 1], q[i + 2], d[i + 1], d[i + 2], d[i + 3],
                            air[i + 1], air[i + 2]);
      }
      GLOAM_IVDEP
      // NOLINTBEGIN(clang-analyzer-*): a row has a cell, so all of its faces have a flux
      for (int i = 0; i < n; ++i) field[i] = max(field[i] - (flux[i + 1] - flux[i]), 0.0f);
      row_escaped_[size_t(k * s.ny + j) * kScalars + f] = double(flux[n]) - double(flux[0]);
      // NOLINTEND(clang-analyzer-*)
    }
  });
}

/// Along y or z: rows of x in lanes, one after the other, with what the next ones need of those
/// that have been changed already.
void Transport::sweep_across(const Sweep& sweep) {
  const Shape& s = shape_;
  for_slabs(sweep.axis == 1 ? s.nz : s.ny, [&](int slab) {
    const int first = sweep.axis == 1 ? s.at(0, 0, slab) : s.at(0, slab, 0);
    for (int i = 0; i < s.nx; i += kBlock) {
      sweep_block(sweep, first + i, std::min(kBlock, s.nx - i),
                  &row_escaped_[size_t(slab) * kScalars]);
    }
  });
}

void Transport::sweep_block(const Sweep& sweep, int first, int width, double* escaped) {
  const Shape& s = shape_;
  const int n = s.n(sweep.axis), stride = s.stride(sweep.axis);
  // Rows beyond those that hold something stay as they are, but for one to each side.
  bool any[kScalars] = {};
  int low = n, high = -1;
  for (size_t f = 0; f < kScalars; ++f) {
    const float* field = sweep.scalars[f].data() + first;
    int m = 0, last = n - 1;
    while (m < n && !holds_any(field + m * stride, width)) ++m;
    if (m == n) continue;
    while (!holds_any(field + last * stride, width)) --last;
    any[f] = true;
    low = std::min(low, m), high = std::max(high, last);
  }
  if (high < 0) return;
  const int begin_face = std::max(low - 1, 0), end_face = std::min(high + 2, n);

  Row rows[4];
  float flux[2][kScalars][kBlock];
  const auto load = [&](int m) {  // row m of cells, and its face to the row before it
    Row& row = rows[(m + 4) % 4];
    const Row& before = rows[(m + 3) % 4];
    const int begin = first + m * stride;
    const bool ghost = m < 0 || m >= n;
    if (ghost) {
      std::fill_n(row.air, width, 1.0f);
    } else {
      find_air(s, sweep.courant, sweep.before, begin, width, row.air);
    }
    for (size_t f = 0; f < kScalars; ++f) {
      if (!any[f]) continue;
      const float* field = sweep.scalars[f].data() + begin;
      if (ghost) {
        std::fill_n(row.q[f], width, 0.0f);
      } else {
        GLOAM_IVDEP
        for (int i = 0; i < width; ++i) row.q[f][i] = field[i] / row.air[i];
      }
      if (m < begin_face || m > n) {  // zero on both sides
        std::fill_n(row.d[f], width, 0.0f);
      } else {
        const float* open = sweep.open + begin;
        GLOAM_IVDEP
        for (int i = 0; i < width; ++i) row.d[f][i] = open[i] * (row.q[f][i] - before.q[f][i]);
      }
    }
  };
  for (int m = begin_face - 1; m <= begin_face + 1; ++m) load(m);
  for (int m = begin_face; m <= end_face; ++m) {
    // Face m, between the rows of cells m - 1 and m; row m + 1 is there for its slope.
    const Row &b = rows[(m + 3) % 4], &c = rows[m % 4], &d = rows[(m + 1) % 4];
    const int begin = first + m * stride;
    const float* courant = courant_[sweep.axis].data() + begin;
    for (size_t f = 0; f < kScalars; ++f) {
      if (!any[f]) continue;
      float* now = flux[m % 2][f];
      const float* last = flux[(m + 1) % 2][f];
      GLOAM_IVDEP
      for (int i = 0; i < width; ++i) {
        now[i] = face_flux(courant[i], b.q[f][i], c.q[f][i], b.d[f][i], c.d[f][i], d.d[f][i],
                           b.air[i], c.air[i]);
      }
      if (m == 0 || m == n) {
        double sum = 0;
        for (int i = 0; i < width; ++i) sum += double(now[i]);
        escaped[f] += m == 0 ? -sum : sum;
      }
      if (m == begin_face) continue;
      float* field = sweep.scalars[f].data() + begin - stride;
      GLOAM_IVDEP
      for (int i = 0; i < width; ++i) field[i] = max(field[i] - (now[i] - last[i]), 0.0f);
    }
    load(m + 2);
  }
}

}  // namespace gloam::gas

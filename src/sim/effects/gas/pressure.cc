#include "sim/effects/gas/pressure.h"

#include <cmath>

namespace gloam::gas {

Pressure::Pressure(const Shape& shape) : shape_(shape), multigrid_(shape) {
  for (Field* f : {&x_, &target_, &residual_, &z_, &p_, &ap_}) {
    f->assign(size_t(shape.size()), 0.0f);
  }
  partial_.resize(size_t(shape.nz));
}

double Pressure::dot(const Field& a, const Field& b) {
  const float *x = a.data(), *y = b.data();
  return grid_sum(shape_, partial_, [&, x, y](int j, int k) {
    return row_sum(shape_.at(0, j, k), shape_.nx, [x, y](int c) { return x[c] * y[c]; });
  });
}

/// Outflow that each cell should have.
void Pressure::set_target(const Openings& openings, const Faces<const float>& velocity,
                          const float* wanted, float scale) {
  const Shape& s = shape_;
  const float* inverse = multigrid_.finest().inverse;
  for_rows(s, [&](int j, int k) {
    const int begin = s.at(0, j, k);
    // A cell without open faces has what its walls leave it.
    GLOAM_IVDEP
    for (int c = begin; c < begin + s.nx; ++c) {
      target_[size_t(c)] = inverse[c] > 0.0f ? wanted[c] * scale : outflow(s, velocity, c);
    }
  });
  if (openings.enclosed == 0) return;
  space_sum_.assign(size_t(openings.enclosed) + 1, 0.0);
  space_count_.assign(space_sum_.size(), 0.0);
  space_faces_.assign(space_sum_.size(), 0.0);
  // First the mean of the wanted divergence goes; then the walls' flux, as if air leaked past what
  // moves, evenly; without such walls what rounding left goes from all cells.
  for (int pass = 0; pass < 2; ++pass) {
    for (int k = 0; k < s.nz; ++k) {
      for (int j = 0; j < s.ny; ++j) {
        const int begin = s.at(0, j, k);
        for (int c = begin; c < begin + s.nx; ++c) {
          const size_t space = size_t(openings.space[size_t(c)]);
          if (space == 0) continue;
          if (pass == 0) {
            space_sum_[space] += double(target_[size_t(c)]);
            space_count_[space] += 1;
            space_faces_[space] += openings.moving_faces(c);
          } else {
            space_sum_[space] += double(target_[size_t(c)] - outflow(s, velocity, c));
          }
        }
      }
    }
    for_rows(s, [&](int j, int k) {
      const int begin = s.at(0, j, k);
      for (int c = begin; c < begin + s.nx; ++c) {
        const size_t space = size_t(openings.space[size_t(c)]);
        if (space == 0) continue;
        const bool leaks = pass == 1 && space_faces_[space] > 0;
        const double share =
            leaks ? openings.moving_faces(c) / space_faces_[space] : 1.0 / space_count_[space];
        target_[size_t(c)] -= float(space_sum_[space] * share);
      }
    });
    std::fill(space_sum_.begin(), space_sum_.end(), 0.0);
  }
}

void Pressure::push(const Faces<float>& velocity, const Field& share) {
  const float *x = x_.data(), *part = share.data();
  subtract(velocity, [x, part](const float* open, int c, int stride) {
    return pressed(open, part, x, c, stride);
  });
}

/// Calls change(weights, c, stride) for each face: what its velocity loses.
template <class Change>
void Pressure::subtract(const Faces<float>& velocity, const Change& change) {
  const Shape& s = shape_;
  const Faces<const float> open = this->open();
  // A row of cells with the faces before it, so that all three axes read pressures once.
  for_rows(Shape{s.nx, s.ny + 1, s.nz + 1, s.sy, s.sz}, [&](int j, int k) {
    for (int axis = 0; axis < 3; ++axis) {
      const Shape faces = s.faces(axis);
      if (j >= faces.ny || k >= faces.nz) continue;
      const int begin = s.at(0, j, k), end = begin + faces.nx, stride = s.stride(axis);
      const float* w = open[axis];
      float* v = velocity[axis];
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c) v[c] -= change(w, c, stride);
    }
  });
}

Projection Pressure::project(const Openings& openings, const Faces<float>& velocity,
                             const float* wanted, float voxel, float dt) {
  const Shape& s = shape_;
  const uint8_t* open = multigrid_.open_faces();
  const Faces<const float> u = velocity.read();
  const auto rows = [&s](auto&& f) {
    for_rows(s, [&s, &f](int j, int k) {
      const int begin = s.at(0, j, k), end = begin + s.nx;
      f(begin, end);
    });
  };
  set_target(openings, u, wanted, voxel / dt);

  float *x = x_.data(), *r = residual_.data(), *z = z_.data(), *p = p_.data(), *ap = ap_.data();
  const float* target = target_.data();
  const auto square_of_row = [&s, r](int begin) {
    return row_sum(begin, s.nx, [r](int c) { return r[c] * r[c]; });
  };
  Projection out;
  const double before = std::sqrt(grid_sum(s, partial_, [&](int j, int k) {
    const int begin = s.at(0, j, k), end = begin + s.nx;
    GLOAM_IVDEP
    for (int c = begin; c < end; ++c) {
      r[c] = target[c] - outflow(s, u, c);
      x[c] = open[c] != 0 ? x[c] : 0.0f;
    }
    return square_of_row(begin);
  }));
  out.before = before / double(voxel);
  const double goal = kTolerance * before;
  double norm = std::sqrt(grid_sum(s, partial_, [&](int j, int k) {
    const int begin = s.at(0, j, k), end = begin + s.nx;
    GLOAM_IVDEP
    for (int c = begin; c < end; ++c) r[c] -= apply_poisson(s, open[c], x, c);
    return square_of_row(begin);
  }));
  if (norm > before) {  // the last solution is no help
    std::fill(x_.begin(), x_.end(), 0.0f);
    rows([&](int begin, int end) {
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c) r[c] = target[c] - outflow(s, u, c);
    });
    norm = before;
  }
  double rz = 0;
  bool fresh = true;  // no direction to go on from
  while (norm > goal && out.iterations < kMostIterations) {
    ++out.iterations;
    multigrid_.precondition(r, z);
    const double next_rz = dot(residual_, z_);
    const float beta = fresh ? 0.0f : float(next_rz / rz);
    rz = next_rz;
    rows([&, beta](int begin, int end) {
      if (fresh) {
        std::copy(z + begin, z + end, p + begin);
        return;
      }
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c) p[c] = z[c] + beta * p[c];
    });
    fresh = false;
    const double curvature = grid_sum(s, partial_, [&](int j, int k) {
      const int begin = s.at(0, j, k);
      GLOAM_IVDEP
      for (int c = begin; c < begin + s.nx; ++c) ap[c] = apply_poisson(s, open[c], p, c);
      return row_sum(begin, s.nx, [ap, p](int c) { return ap[c] * p[c]; });
    });
    if (!(curvature > 0)) break;  // nothing is left but rounding
    const float alpha = float(rz / curvature);
    const double square = grid_sum(s, partial_, [&, alpha](int j, int k) {
      const int begin = s.at(0, j, k);
      GLOAM_IVDEP
      for (int c = begin; c < begin + s.nx; ++c) {
        x[c] += alpha * p[c];
        r[c] -= alpha * ap[c];
      }
      return square_of_row(begin);
    });
    norm = std::sqrt(square);
    if (norm > goal) continue;
    // The residual of conjugate gradients drifts from the true one: compute that, and go on if need
    // be.
    norm = std::sqrt(grid_sum(s, partial_, [&](int j, int k) {
      const int begin = s.at(0, j, k), end = begin + s.nx;
      GLOAM_IVDEP
      for (int c = begin; c < end; ++c)
        r[c] = target[c] - outflow(s, u, c) - apply_poisson(s, open[c], x, c);
      return square_of_row(begin);
    }));
    fresh = true;
  }

  subtract(velocity, [x](const float* weight, int c, int stride) {
    return weight[c] * (x[c] - x[c - stride]);
  });
  // Error of the velocities themselves: the estimate of conjugate gradients drifts from it.
  out.after = std::sqrt(grid_sum(s, partial_,
                                 [&](int j, int k) {
                                   return row_sum(s.at(0, j, k), s.nx, [&](int c) {
                                     return sqr(target[c] - outflow(s, u, c));
                                   });
                                 })) /
              double(voxel);
  return out;
}

}  // namespace gloam::gas

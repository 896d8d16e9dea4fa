#include "sim/effects/gas/momentum.h"

#include "sim/effects/gas/kernel/carry.h"
#include "sim/effects/gas/kernel/forces.h"
#include "sim/effects/gas/pieces.h"

namespace gloam::gas {
namespace {

Faces<const float> view(const Field (&f)[3]) { return {f[0].data(), f[1].data(), f[2].data()}; }

/// The ghosts next to the box as the cells before them.
void fill_ghosts(const Shape& s, float* f) {
  for_slabs(s.nz, [&s, f](int k) {
    for (int j = 0; j < s.ny; ++j) {
      f[s.at(-1, j, k)] = f[s.at(0, j, k)];
      f[s.at(s.nx, j, k)] = f[s.at(s.nx - 1, j, k)];
    }
    std::copy_n(f + s.at(0, 0, k), s.nx, f + s.at(0, -1, k));
    std::copy_n(f + s.at(0, s.ny - 1, k), s.nx, f + s.at(0, s.ny, k));
  });
  for (int j = 0; j < s.ny; ++j) {
    std::copy_n(f + s.at(0, j, 0), s.nx, f + s.at(0, j, -1));
    std::copy_n(f + s.at(0, j, s.nz - 1), s.nx, f + s.at(0, j, s.nz));
  }
}

}  // namespace

Momentum::Momentum(const Shape& shape) : shape_(shape) {
  const size_t n = size_t(shape.size());
  for (int a = 0; a < 3; ++a) {
    centre_[a].assign(n, 0.0f);
    moved_[a].assign(n, 0.0f);
  }
  for (Field* f : {&trusted_, &smooth_, &carried_, &least_, &most_, &corrected_})
    f->assign(n, 0.0f);
}

void Momentum::find_centres(const Faces<const float>& u, float scale, float limit) {
  const Shape& s = shape_;
  float *x = centre_[0].data(), *y = centre_[1].data(), *z = centre_[2].data();
  const float half = 0.5f * scale;
  for_rows(s, [&, x, y, z](int j, int k) {
    const int begin = s.at(0, j, k);
    GLOAM_IVDEP
    for (int c = begin; c < begin + s.nx; ++c) {
      const Vec3f v = carrier_velocity(s, u, c, half, limit);
      x[c] = v.x, y[c] = v.y, z[c] = v.z;
    }
  });
}

void Momentum::find_paths(const Openings& openings, const Faces<const float>& open) {
  const Shape& s = shape_;
  const Carrier carrier{s, view(centre_)};
  float *x = moved_[0].data(), *y = moved_[1].data(), *z = moved_[2].data();
  for_rows(s, [&, x, y, z](int j, int k) {
    const int begin = s.at(0, j, k), nx = s.nx;
    {
      const Carrier v = carrier;
      float *const to_x = x + begin, *const to_y = y + begin, *const to_z = z + begin;
      for_pieces(nx, [&](int from, int width) {
        Ways ways;
        GLOAM_IVDEP
        for (int l = 0; l < width; ++l) ways.set(l, {half_way(v, from + l, j, k), 0.0f});
        const bool even = ways.are_even(width);
        const float* const fields[3] = {v.velocity.x, v.velocity.y, v.velocity.z};
        float* const to[3] = {to_x + from, to_y + from, to_z + from};
        for (int a = 0; a < 3; ++a) {
          const float* const field = fields[a];
          float* const d = to[a];
          if (even) {
            GLOAM_IVDEP
            for (int l = 0; l < width; ++l)
              d[l] = interpolate(ways.even_corners(v.shape, field, l), ways.get(l).at);
          } else {
            GLOAM_IVDEP
            for (int l = 0; l < width; ++l) d[l] = interpolate(v.shape, field, ways.get(l).at);
          }
        }
      });
    }
    // Walls may be in the way where it is longer than what is clear around the cell.
    uint8_t near[kLongestRow];
    {
      const Faces<const float> v = carrier.velocity;
      const float *const dx = x + begin, *const dy = y + begin, *const dz = z + begin;
      const float *const vx = v.x + begin, *const vy = v.y + begin, *const vz = v.z + begin;
      const uint8_t* const clear = openings.clearance.data() + begin;
      float* const trusted = trusted_.data() + begin;
      GLOAM_IVDEP
      for (int i = 0; i < nx; ++i) {
        const Vec3f d{dx[i], dy[i], dz[i]}, u{vx[i], vy[i], vz[i]};
        near[i] = comes_near_walls(d, u, clear[i]) ? 1 : 0;
        trusted[i] = 1.0f;
      }
    }
    for (int i = 0; i < nx; ++i) {
      if (!near[i]) continue;
      const int c = begin + i;
      Vec3f moved;
      const bool trusted =
          !openings.solid[size_t(c)] && displacement_near_walls(carrier, open, i, j, k, &moved);
      trusted_[size_t(c)] = trusted ? 1.0f : 0.0f;
      x[c] = moved.x, y[c] = moved.y, z[c] = moved.z;
    }
  });
  for (Field& f : moved_) fill_ghosts(s, f.data());
  fill_ghosts(s, trusted_.data());
  for (Field& f : centre_) fill_ghosts(s, f.data());
}

void Momentum::find_smoothness() {
  const Shape& s = shape_;
  const Faces<const float> v = view(centre_);
  float* smooth = smooth_.data();
  for_rows(s, [&, v, smooth](int j, int k) {
    const int begin = s.at(0, j, k);
    GLOAM_IVDEP
    for (int c = begin; c < begin + s.nx; ++c) smooth[c] = smoothness_at(s, v, c);
  });
  fill_ghosts(s, smooth);
}

void Momentum::carry_axis(const Openings& openings, int axis, const float* open, Field* field,
                          Vec3f wind, float drift) {
  const Shape& s = shape_;
  const Shape faces = s.faces(axis);
  const float outside = wind[axis];
  const auto side = [&openings](int n) { return openings.side_open[n] ? 1.0f : 0.0f; };
  const CarryView view{s,
                       axis,
                       s.stride(axis),
                       outside,
                       {side(0), side(1), side(2), side(3), side(4), side(5)},
                       gas::view(moved_),
                       gas::view(centre_),
                       trusted_.data(),
                       open,
                       field->data(),
                       carried_.data(),
                       least_.data(),
                       most_.data(),
                       corrected_.data()};
  for_rows(faces, [&view, nx = faces.nx](int j, int k) {
    const CarryView v = view;  // its own copy: the compiler need not look at it again for each face
    for_ways(
        v, v.old, j, k, nx, [&v, j, k](int i) { return way_back(v, i, j, k); },
        [&v](int c, const Corners& a, const Way& way) { set_carried(v, c, a, way); });
  });
  for_rows(faces, [&view, nx = faces.nx](int j, int k) {
    const CarryView v = view;
    for_ways(
        v, v.carried, j, k, nx, [&v, j, k](int i) { return way_forth(v, i, j, k); },
        [&v](int c, const Corners& a, const Way& way) { set_corrected(v, c, a, way); });
  });
  for (int side = 0; side < 2; ++side) {
    const float inward = side == 0 ? outside : -outside;
    if (!(inward > 0.0f)) continue;
    const float share = min(inward * drift, 1.0f);
    for (int e = 0; e < (axis == 2 ? s.ny : s.nz); ++e) {
      for (int d = 0; d < (axis == 0 ? s.ny : s.nx); ++d) {
        const int far = side == 0 ? 0 : s.n(axis);
        const int c = axis == 0 ? s.at(far, d, e) : (axis == 1 ? s.at(d, far, e) : s.at(d, e, far));
        corrected_[size_t(c)] = let_in(view, c, share);
      }
    }
  }
  field->swap(corrected_);
}

void Momentum::trace(const Openings& openings, const Faces<const float>& open,
                     const Faces<const float>& velocity, float voxel, float dt) {
  find_centres(velocity, dt / voxel, float(kReach));
  find_paths(openings, open);
  find_smoothness();
}

void Momentum::carry(const Openings& openings, const Faces<const float>& open, Field (&velocity)[3],
                     float voxel, float dt, Vec3f wind) {
  for (int a = 0; a < 3; ++a) {
    carry_axis(openings, a, open[a], &velocity[a], wind, dt / (voxel * kInflow));
  }
}

void Momentum::lift(const Faces<const float>& open, const Faces<float>& velocity, const float* heat,
                    const float* smoke, float ambient_density, float dt, uint32_t count) {
  const Shape& s = shape_;
  const LiftView view{s, open.z, smooth_.data(), heat, smoke, ambient_density, dt, count};
  float* u = velocity.z;
  for_rows(s.faces(2), [&view, u](int j, int k) {
    const LiftView v = view;
    const int begin = v.shape.at(0, j, k), end = begin + v.shape.nx;
    GLOAM_IVDEP
    for (int c = begin; c < end; ++c) u[c] += gas::lift(v, c);
  });
}

void Momentum::confine(const Faces<const float>& open, const Faces<float>& velocity, float strength,
                       float dt) {
  const Shape& s = shape_;
  find_centres(velocity.read(), 1.0f, 1e6f);
  for (Field& f : centre_) fill_ghosts(s, f.data());
  const Faces<const float> v = view(centre_);
  float* length = trusted_.data();
  for_rows(s, [&, length](int j, int k) {
    const int begin = s.at(0, j, k);
    GLOAM_IVDEP
    for (int c = begin; c < begin + s.nx; ++c) {
      const Vec3f w = curl(s, v, c);
      length[c] = sqrtf(dot(w, w));
    }
  });
  fill_ghosts(s, length);
  for_rows(s, [&, length](int j, int k) {
    const int begin = s.at(0, j, k);
    GLOAM_IVDEP
    for (int c = begin; c < begin + s.nx; ++c) {
      const Vec3f f = confinement(s, v, length, c) * (1.0f - smooth_[size_t(c)]);
      moved_[0][size_t(c)] = f.x, moved_[1][size_t(c)] = f.y, moved_[2][size_t(c)] = f.z;
    }
  });
  for (int a = 0; a < 3; ++a) {
    fill_ghosts(s, moved_[a].data());
    const float* f = moved_[a].data();
    const float* w = open[a];
    float* u = velocity[a];
    const int stride = s.stride(a);
    // curl() holds two voxels of length and so does its gradient: one voxel of each is left.
    const float scale = 0.25f * strength * dt;
    for_rows(s.faces(a), [&, f, w, u](int j, int k) {
      const int begin = s.at(0, j, k);
      GLOAM_IVDEP
      for (int c = begin; c < begin + s.faces(a).nx; ++c) {
        u[c] += w[c] * scale * (f[c] + f[c - stride]);
      }
    });
  }
}

}  // namespace gloam::gas

// The undersides of spheres and capsules: what a ball sweeps from one end of a way to the other.
// Many places at once, without branches. Of the balls over a place, or across a line, that which
// reaches farthest is found on an endless way and then kept between the ends: how far they reach is
// convex along it.

#include <algorithm>
#include <cmath>

#include "sim/effects/bodies/collider_bottom.h"

namespace gloam {
namespace {

constexpr double kNoLength = 1e-18;    // square of one that a division needs
constexpr double kSteepestRim = 1e-3;  // z of a normal below which the surface counts as a wall

struct Sweep {
  double a[3], u[3];      // beginning [m] and direction
  double length, radius;  // [m]
};

Sweep sweep_of(bool capsule, const double* p, const double* R, const double* size) {
  Sweep out{{p[0], p[1], p[2]}, {R[2], R[5], R[8]}, 0, size[0]};
  if (!capsule) return out;
  for (int i = 0; i < 3; ++i) out.a[i] -= size[1] * out.u[i];
  out.length = 2 * size[1];
  return out;
}

double between(double x, double low, double high) {
  x = x > low ? x : low;
  return x < high ? x : high;
}

double root(double x) { return std::sqrt(x > 0 ? x : 0); }

}  // namespace

void ColliderBottom::round_ends(double level, std::span<const double> ys, double* left,
                                double* right) const {
  const Sweep b = sweep_of(type_ == mjGEOM_CAPSULE, p_, R_, size_);
  const double ux = b.u[0], uz = b.u[2], r2 = b.radius * b.radius, qz = level - b.a[2];
  // Seen from above, and in the plane of the level.
  const double uy = std::copysign(std::max(std::abs(b.u[1]), 1e-9), b.u[1]);
  const double flat = std::max(ux * ux + uy * uy, kNoLength);
  const double cut = std::max(uy * uy + uz * uz, kNoLength);
  const double ahead = ux * b.radius / (std::abs(uy) * std::sqrt(flat)), per_uy = 1 / uy;
  const double per_cut = 1 / cut, cut_ahead = ux / std::sqrt(cut);
  for (size_t i = 0; i < ys.size(); ++i) {
    const double qy = ys[i] - b.a[1], s0 = qy * per_uy;
    const double c0 = (qy * uy + qz * uz) * per_cut;
    const double c_ahead = cut_ahead * root(r2 - (qy * qy + qz * qz) + c0 * c0 * cut);
    double ends[2];
    bool hit = true;
    for (int n = 0; n < 2; ++n) {
      const double side = n == 0 ? -1 : 1;
      const double s = between(s0 + side * ahead, 0, b.length), dy = qy - s * uy;
      const double t = between(c0 + side * c_ahead, 0, b.length);
      const double ty = qy - t * uy, tz = qz - t * uz;
      const double wide = r2 - dy * dy, narrow = r2 - ty * ty - tz * tz;
      const bool deep = s * uz <= qz;
      ends[n] = deep ? s * ux + side * root(wide) : t * ux + side * root(narrow);
      hit = hit & (wide > 0) & (deep | (narrow > 0));
    }
    left[i] = hit ? b.a[0] + ends[0] : 1;
    right[i] = hit ? b.a[0] + ends[1] : 0;
  }
}

void ColliderBottom::round_at(std::span<const double> xs, const double* ys, double* z,
                              double* slope_x, double* slope_y) const {
  const Sweep b = sweep_of(type_ == mjGEOM_CAPSULE, p_, R_, size_);
  const double ux = b.u[0], uy = b.u[1], uz = b.u[2], r2 = b.radius * b.radius;
  const double flat = std::max(ux * ux + uy * uy, kNoLength), per_flat = 1 / flat;
  const double ahead = uz / std::sqrt(flat), steepest = kSteepestRim * b.radius;
  for (size_t i = 0; i < xs.size(); ++i) {
    const double qx = xs[i] - b.a[0], qy = ys[i] - b.a[1];
    const double s0 = (qx * ux + qy * uy) * per_flat;
    const double away = qx * qx + qy * qy - s0 * s0 * flat;
    const double s = between(s0 - ahead * root(r2 - away), 0, b.length);
    const double dx = qx - s * ux, dy = qy - s * uy;
    const double square = r2 - dx * dx - dy * dy, down = root(square);
    z[i] = square >= 0 ? b.a[2] + s * uz - down : kNoSurface;
    const double per_down = 1 / (down > steepest ? down : steepest);
    slope_x[i] = dx * per_down, slope_y[i] = dy * per_down;
  }
}

}  // namespace gloam

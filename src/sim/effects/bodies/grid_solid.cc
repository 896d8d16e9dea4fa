#include "sim/effects/bodies/grid_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gloam {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kParallel = 1e-9;  // sine of an angle under which a line never meets a plane

struct Interval {
  double lo = kEndless, hi = -kEndless;  // empty
};

// a t² + 2 b t + c <= 0. a >= 0; where it is 0 the line is parallel to what it asks about.
Interval solve(double a, double b, double c) {
  if (a < kParallel * kParallel) return c <= 0 ? Interval{-kEndless, kEndless} : Interval{};
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return {};
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

Interval in_ellipsoid(const double* q, const double* u, const double* radii) {
  double a = 0, b = 0, c = -1;
  for (int i = 0; i < 3; ++i) {
    const double w = 1 / radii[i];
    a += u[i] * w * u[i] * w, b += q[i] * w * u[i] * w, c += q[i] * w * q[i] * w;
  }
  return solve(a, b, c);
}

Interval in_cylinder(const double* q, const double* u, double radius, double half) {
  Interval in = solve(u[0] * u[0] + u[1] * u[1], q[0] * u[0] + q[1] * u[1],
                      q[0] * q[0] + q[1] * q[1] - radius * radius);
  if (std::abs(u[2]) < kParallel) return std::abs(q[2]) <= half ? in : Interval{};
  const double ends[2] = {(-half - q[2]) / u[2], (half - q[2]) / u[2]};
  in.lo = std::max(in.lo, std::min(ends[0], ends[1]));
  in.hi = std::min(in.hi, std::max(ends[0], ends[1]));
  return in;
}

// A rod with a ball at either end: convex, so what lies between two of its points is inside.
Interval in_capsule(const double* q, const double* u, double radius, double half) {
  const double radii[3] = {radius, radius, radius};
  const double below[3] = {q[0], q[1], q[2] + half}, above[3] = {q[0], q[1], q[2] - half};
  Interval all;
  for (const Interval& part : {in_cylinder(q, u, radius, half), in_ellipsoid(below, u, radii),
                               in_ellipsoid(above, u, radii)}) {
    if (part.lo > part.hi) continue;
    all.lo = std::min(all.lo, part.lo);
    all.hi = std::max(all.hi, part.hi);
  }
  return all;
}

}  // namespace

void GridSolid::set_pose(const GasGrid& grid, const double* p, const double* R) {
  voxel_ = grid.voxel;
  for (int i = 0; i < 3; ++i) p_[i] = (p[i] - double{grid.low[i]}) / voxel_;
  std::copy(R, R + 9, R_);
}

void GridSolid::bound(const double* centre, const double* half) {
  const double more = kWallTolerance;
  for (int i = 0; i < 3; ++i) {
    double mid = 0, reach = 0;
    for (int j = 0; j < 3; ++j) {
      mid += R_[3 * i + j] * centre[j];
      reach += std::abs(R_[3 * i + j]) * (half[j] + more);
    }
    low_[i] = p_[i] + (mid - reach) / voxel_;
    high_[i] = p_[i] + (mid + reach) / voxel_;
  }
}

void GridSolid::add_plane(const SolidPlane& plane) {
  SolidPlane& out = planes_.emplace_back();
  out.offset = (plane.offset + kWallTolerance) / voxel_;
  for (int i = 0; i < 3; ++i) {
    out.n[i] = R_[3 * i] * plane.n[0] + R_[3 * i + 1] * plane.n[1] + R_[3 * i + 2] * plane.n[2];
    out.offset += out.n[i] * p_[i];
  }
}

void GridSolid::make_polyhedron(std::span<const SolidPlane> planes, const double* centre,
                                const double* half) {
  kind_ = Kind::kPlanes;
  planes_.clear();
  for (const SolidPlane& plane : planes) add_plane(plane);
  bound(centre, half);
}

bool GridSolid::make_primitive(int type, const double* size) {
  const double origin[3] = {};
  double half[3] = {size[0], size[0], size[0]};
  switch (type) {
    case mjGEOM_PLANE: {  // everything under it: MuJoCo's planes end nowhere
      const SolidPlane top{{0, 0, 1}, 0};
      make_polyhedron({&top, 1}, origin, half);
      std::fill(low_, low_ + 3, -kEndless);
      std::fill(high_, high_ + 3, kEndless);
      return true;
    }
    case mjGEOM_BOX: {
      const SolidPlane sides[6] = {{{1, 0, 0}, size[0]},  {{0, 1, 0}, size[1]},
                                   {{0, 0, 1}, size[2]},  {{-1, 0, 0}, size[0]},
                                   {{0, -1, 0}, size[1]}, {{0, 0, -1}, size[2]}};
      make_polyhedron(sides, origin, size);
      return true;
    }
    case mjGEOM_SPHERE:
      kind_ = Kind::kEllipsoid;
      std::fill(size_, size_ + 3, (size[0] + kWallTolerance) / voxel_);
      break;
    case mjGEOM_ELLIPSOID:
      kind_ = Kind::kEllipsoid;
      for (int i = 0; i < 3; ++i) size_[i] = (size[i] + kWallTolerance) / voxel_;
      std::copy(size, size + 3, half);
      break;
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
      kind_ = type == mjGEOM_CAPSULE ? Kind::kCapsule : Kind::kCylinder;
      for (int i = 0; i < 2; ++i) size_[i] = (size[i] + kWallTolerance) / voxel_;
      half[2] = size[1] + (type == mjGEOM_CAPSULE ? size[0] : 0);
      break;
    default:
      return false;
  }
  bound(origin, half);
  return true;
}

// Row by row and plane by plane, so that the inner loop is one of vectors.
void GridSolid::inside_planes(int axis, int b0, int c, int n, double grow, double* lo,
                              double* hi) const {
  const int axis_b = axis == 0 ? 1 : 0, axis_c = axis == 2 ? 1 : 2;
  std::fill(lo, lo + n, low(axis, grow));
  std::fill(hi, hi + n, high(axis, grow));
  for (const SolidPlane& plane : planes_) {
    const double along = plane.n[axis], across = plane.n[axis_b];
    const double left = plane.offset + grow - plane.n[axis_c] * (c + 0.5) - across * (b0 + 0.5);
    if (std::abs(along) < kParallel) {
      for (int i = 0; i < n; ++i) lo[i] = left - across * i < 0 ? kEndless : lo[i];
      continue;
    }
    const double at = left / along, slope = -across / along;
    if (along > 0) {
      for (int i = 0; i < n; ++i) hi[i] = std::min(hi[i], at + slope * i);
    } else {
      for (int i = 0; i < n; ++i) lo[i] = std::max(lo[i], at + slope * i);
    }
  }
}

void GridSolid::inside(int axis, int b0, int c, int n, double grow, double* lo, double* hi) const {
  if (kind_ == Kind::kPlanes) return inside_planes(axis, b0, c, n, grow, lo, hi);
  const double size[3] = {size_[0] + grow, size_[1] + grow, size_[2] + grow};
  const double* u = R_ + 3 * axis;  // the line's direction in the solid's frame
  double d[3] = {};
  d[axis == 2 ? 1 : 2] = c + 0.5 - p_[axis == 2 ? 1 : 2];
  for (int i = 0; i < n; ++i) {
    d[axis == 0 ? 1 : 0] = b0 + i + 0.5 - p_[axis == 0 ? 1 : 0];
    double q[3];
    for (int j = 0; j < 3; ++j) q[j] = R_[j] * d[0] + R_[3 + j] * d[1] + R_[6 + j] * d[2];
    Interval in;
    if (kind_ == Kind::kEllipsoid) in = in_ellipsoid(q, u, size);
    if (kind_ == Kind::kCylinder) in = in_cylinder(q, u, size[0], size[1]);
    if (kind_ == Kind::kCapsule) in = in_capsule(q, u, size[0], size_[1]);
    lo[i] = in.lo + p_[axis];
    hi[i] = in.hi + p_[axis];
  }
}

}  // namespace gloam

#include "sim/effects/bodies/collider_bottom.h"

#include <algorithm>
#include <cmath>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/bodies/collider_mesh.h"

namespace gloam {
namespace {

constexpr double kVerticalNormalZ = 1e-9;  // z of a normal below which the facet is a wall
constexpr double kWallNormalZ = 1e-3;      // z of a normal below which the surface counts as a wall

}  // namespace

bool ColliderBottom::can_be(const mjModel& m, int geom) {
  switch (m.geom_type[geom]) {
    case mjGEOM_SPHERE:
    case mjGEOM_ELLIPSOID:
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
    case mjGEOM_BOX:
    case mjGEOM_MESH:
      return true;
    default:
      return false;
  }
}

ColliderBottom::ColliderBottom(const mjModel& m, int geom)
    : geom_(geom), body_(m.geom_bodyid[geom]), type_(m.geom_type[geom]) {
  std::copy_n(m.geom_size + 3 * geom, 3, size_);
  std::copy_n(m.geom_aabb + 6 * geom, 3, box_centre_);
  std::copy_n(m.geom_aabb + 6 * geom + 3, 3, box_half_);
  if (type_ == mjGEOM_MESH) planes_ = hull_planes(m, m.geom_dataid[geom]);
  if (type_ == mjGEOM_BOX) {
    for (int a = 0; a < 3; ++a) {
      for (const double side : {-1.0, 1.0}) {
        SolidPlane plane{{0, 0, 0}, size_[a]};
        plane.n[a] = side;
        planes_.push_back(plane);
      }
    }
  }
  lower_.reserve(planes_.size());
  upper_.reserve(planes_.size());
  upright_.reserve(planes_.size());
}

void ColliderBottom::set_pose(const mjData& d) {
  std::copy_n(d.geom_xpos + 3 * geom_, 3, p_);
  std::copy_n(d.geom_xmat + 9 * geom_, 9, R_);
  for (int a = 0; a < 3; ++a) p_G_[a] = -(R_[a] * p_[0] + R_[3 + a] * p_[1] + R_[6 + a] * p_[2]);
  mju_mulMatVec3(centre_, R_, box_centre_);
  mju_addTo3(centre_, p_);
  for (int a = 0; a < 3; ++a) half_[a] = reach(R_ + 3 * a);
  const double a = R_[6] * R_[6] + R_[7] * R_[7];
  per_round_ = a > kVerticalNormalZ * kVerticalNormalZ ? 1 / a : 0;
  per_upright_ = std::abs(R_[8]) > kVerticalNormalZ ? 1 / R_[8] : 0;
  lower_.clear(), upper_.clear(), upright_.clear();
  for (const SolidPlane& plane : planes_) {
    SolidPlane world;
    mju_mulMatVec3(world.n, R_, plane.n);
    world.offset = plane.offset + mju_dot3(world.n, p_);
    if (std::abs(world.n[2]) < kVerticalNormalZ) {
      upright_.push_back(world);
      continue;
    }
    const Facet facet{-world.n[0] / world.n[2], -world.n[1] / world.n[2],
                      world.offset / world.n[2]};
    (world.n[2] < 0 ? lower_ : upper_).push_back(facet);
  }
}

bool ColliderBottom::at(double x, double y, BottomPoint* out) const {
  if (std::abs(x - centre_[0]) > half_[0] || std::abs(y - centre_[1]) > half_[1]) return false;
  if (is_round()) {
    round_at({&x, 1}, &y, &out->z, &out->slope[0], &out->slope[1]);
    return out->z < kNoSurface;
  }
  if (!planes_.empty()) {
    const Facet* facet = facet_at(x, y, &out->z);
    if (facet == nullptr) return false;
    out->slope[0] = facet->a, out->slope[1] = facet->b;
    return true;
  }
  double normal[3] = {}, n[3];
  if (!quadric_at(x, y, &out->z, normal)) return false;
  for (int a = 0; a < 3; ++a) n[a] = dot3(R_ + 3 * a, normal);
  // The normal is scaled to unit length first.
  const double down = std::min(n[2], -kWallNormalZ * std::sqrt(dot3(n, n)));
  out->slope[0] = -n[0] / down, out->slope[1] = -n[1] / down;
  return true;
}

void ColliderBottom::at_each(std::span<const double> xs, const double* ys, double* z,
                             double* slope_x, double* slope_y) const {
  if (is_round()) return round_at(xs, ys, z, slope_x, slope_y);
  for (size_t i = 0; i < xs.size(); ++i) {
    BottomPoint point;
    z[i] = at(xs[i], ys[i], &point) ? point.z : kNoSurface;
    slope_x[i] = point.slope[0], slope_y[i] = point.slope[1];
  }
}

bool ColliderBottom::height_at(double x, double y, double* z) const {
  if (std::abs(x - centre_[0]) > half_[0] || std::abs(y - centre_[1]) > half_[1]) return false;
  if (!planes_.empty()) return facet_at(x, y, z) != nullptr;
  double out[3];
  if (!is_round()) return quadric_at(x, y, z, out);
  round_at({&x, 1}, &y, z, out, out + 1);
  return *z < kNoSurface;
}

// Null: it is not above (x, y).
const ColliderBottom::Facet* ColliderBottom::facet_at(double x, double y, double* z) const {
  for (const SolidPlane& wall : upright_)
    if (wall.n[0] * x + wall.n[1] * y > wall.offset) return nullptr;
  double low = -kNoSurface, high = kNoSurface;
  const Facet* lowest = nullptr;
  for (const Facet& f : lower_) {
    const double at = f.a * x + f.b * y + f.c;
    if (at > low) low = at, lowest = &f;
  }
  for (const Facet& f : upper_) high = std::min(high, f.a * x + f.b * y + f.c);
  *z = low;
  return low > high ? nullptr : lowest;
}

// The upright line through (x, y), in the geom's frame: o + t d, where t is the world's z.
bool ColliderBottom::quadric_at(double x, double y, double* out, double* normal) const {
  double o[3];
  for (int a = 0; a < 3; ++a) o[a] = p_G_[a] + x * R_[a] + y * R_[3 + a];
  const double* d = R_ + 6;
  if (type_ == mjGEOM_CYLINDER) return cylinder_at(o, d, out, normal);
  // An ellipsoid: a ball of radius 1 in a frame that is stretched.
  double a = 0, b = 0, c = -1;
  for (int i = 0; i < 3; ++i) {
    const double q = o[i] / size_[i], e = d[i] / size_[i];
    a += e * e, b += q * e, c += q * q;
  }
  const double root = b * b - a * c;
  if (root < 0) return false;
  *out = (-b - std::sqrt(root)) / a;
  for (int i = 0; i < 3; ++i) normal[i] = (o[i] + *out * d[i]) / (size_[i] * size_[i]);
  return true;
}

// Entry point of the line: through the round side, then normal[2] = 0, or through an end.
bool ColliderBottom::cylinder_at(const double* o, const double* d, double* t,
                                 double* normal) const {
  double low = -kNoSurface, high = kNoSurface;
  const double b = o[0] * d[0] + o[1] * d[1];
  const double c = o[0] * o[0] + o[1] * o[1] - size_[0] * size_[0];
  if (per_round_ > 0) {
    const double middle = -b * per_round_, square = middle * middle - c * per_round_;
    if (square < 0) return false;
    const double half = std::sqrt(square);
    low = middle - half, high = middle + half;
  } else if (c > 0) {
    return false;
  }
  bool end = false;
  if (per_upright_ != 0) {
    const double from = (-std::copysign(size_[1], d[2]) - o[2]) * per_upright_;
    const double to = (std::copysign(size_[1], d[2]) - o[2]) * per_upright_;
    if (from > low) low = from, end = true;
    high = std::min(high, to);
  } else if (std::abs(o[2]) > size_[1]) {
    return false;
  }
  if (low > high) return false;
  *t = low;
  normal[0] = end ? 0 : o[0] + low * d[0];
  normal[1] = end ? 0 : o[1] + low * d[1];
  normal[2] = end ? -std::copysign(1.0, d[2]) : 0;
  return true;
}

}  // namespace gloam

// Bounding boxes of colliders, and their motion.

#include <algorithm>
#include <cmath>

#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/bodies/collider_bottom.h"

namespace gloam {
namespace {
constexpr double kLevel = 1e-9;  // z of an axis below which it lies level
}

// From its middle along an axis of the world, which is `n` in the geom's frame [m].
double ColliderBottom::reach(const double* n) const {
  const auto across = [&] { return std::sqrt(std::max(1 - n[2] * n[2], 0.0)); };
  switch (type_) {
    case mjGEOM_SPHERE:
      return size_[0];
    case mjGEOM_CAPSULE:
      return size_[0] + size_[1] * std::abs(n[2]);
    case mjGEOM_CYLINDER:
      return size_[0] * across() + size_[1] * std::abs(n[2]);
    case mjGEOM_ELLIPSOID: {
      const double e[3] = {size_[0] * n[0], size_[1] * n[1], size_[2] * n[2]};
      return std::sqrt(dot3(e, e));
    }
    default:
      return std::abs(n[0]) * box_half_[0] + std::abs(n[1]) * box_half_[1] +
             std::abs(n[2]) * box_half_[2];
  }
}

void ColliderBottom::box_below(double level, double* low, double* high) const {
  for (int a = 0; a < 2; ++a) low[a] = this->low(a), high[a] = this->high(a);
  const double rise = std::abs(R_[8]), over = level + size_[0] - centre_[2];
  if (type_ != mjGEOM_CAPSULE || over >= rise * size_[1] || rise < kLevel) return;
  // From its lower end to where its axis has risen that far.
  const double down = R_[8] > 0 ? -size_[1] : size_[1], up = over / R_[8];
  for (int a = 0; a < 2; ++a) {
    const double from = p_[a] + down * R_[3 * a + 2], to = p_[a] + up * R_[3 * a + 2];
    low[a] = std::min(from, to) - size_[0], high[a] = std::max(from, to) + size_[0];
  }
}

void ColliderBottom::anchor_of(const double* point, double* p_G) const {
  const bool round = type_ == mjGEOM_CAPSULE || type_ == mjGEOM_CYLINDER;
  for (int a = 0; a < 3; ++a)
    p_G[a] = p_G_[a] + R_[a] * point[0] + R_[3 + a] * point[1] + R_[6 + a] * point[2];
  if (type_ == mjGEOM_SPHERE || round) p_G[0] = p_G[1] = 0;
  if (type_ == mjGEOM_SPHERE) p_G[2] = 0;
  if (round) p_G[2] = std::clamp(p_G[2], -size_[1], size_[1]);
}

// Angle turned, ignoring symmetries of the shape [rad].
double ColliderBottom::turned(const double* R) const {
  if (type_ == mjGEOM_SPHERE) return 0;
  const bool round = type_ == mjGEOM_CAPSULE || type_ == mjGEOM_CYLINDER;
  double square = 0;
  for (int i = round ? 2 : 0; i < 9; i += round ? 3 : 1) square += (R_[i] - R[i]) * (R_[i] - R[i]);
  return std::sqrt(square);
}

}  // namespace gloam

#include "control/ik/collision_limit.h"

#include <algorithm>
#include <cmath>

#include "control/ik/ranges.h"

namespace gloam::ik {
namespace {

Result<std::vector<int>> geoms_of(const mjModel& model, const std::vector<std::string>& names) {
  std::vector<int> geoms;
  for (const std::string& name : names) {
    GLOAM_TRY(const int geom, find_element(model, mjOBJ_GEOM, "geom", name));
    geoms.push_back(geom);
  }
  return geoms;
}

}  // namespace

bool may_collide(const mjModel& model, int geom1, int geom2) {
  const int weld1 = model.body_weldid[model.geom_bodyid[geom1]];
  const int weld2 = model.body_weldid[model.geom_bodyid[geom2]];
  const int parent1 = model.body_weldid[model.body_parentid[weld1]];
  const int parent2 = model.body_weldid[model.body_parentid[weld2]];
  if (weld1 == weld2 || weld1 == parent2 || weld2 == parent1) return false;
  return (model.geom_contype[geom1] & model.geom_conaffinity[geom2]) != 0 ||
         (model.geom_contype[geom2] & model.geom_conaffinity[geom1]) != 0;
}

Result<GeomPairs> collision_pairs(const mjModel& model, const CollisionLimit& options) {
  GeomPairs pairs;
  for (const auto& [names1, names2] : options.groups) {
    GLOAM_TRY(const std::vector<int> first, geoms_of(model, names1));
    GLOAM_TRY(const std::vector<int> second, geoms_of(model, names2));
    for (const int a : first)
      for (const int b : second)
        if (may_collide(model, a, b)) pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Result<CollisionRows> CollisionRows::create(const Kinematics& at, const CollisionLimit& options,
                                            GeomPairs pairs, int most) {
  const double numbers[] = {options.gain, options.min_distance, options.detection_distance,
                            options.bound_relaxation};
  GLOAM_TRY_STATUS(check_finite(numbers, "a value of a collision limit"));
  if (!(options.gain > 0)) return refuse_value("the gain of a collision limit must be positive");
  if (!(options.bound_relaxation >= 0))
    return refuse_value("'bound_relaxation' of a collision limit must not be negative");
  if (!(options.detection_distance > options.min_distance)) {
    return refuse_value(
        "'detection_distance' of a collision limit must be greater than 'min_distance'");
  }
  CollisionRows rows;
  rows.options_ = options;
  rows.pairs_ = std::move(pairs);
  rows.near_.resize(std::min(rows.pairs_.size(), static_cast<size_t>(most)));
  rows.J1_.resize(3, at.size());
  rows.J2_.resize(3, at.size());
  return rows;
}

// By bounding spheres and planes, as MuJoCo's own filter. Geoms without a bound may be near.
bool CollisionRows::may_be_near(const Kinematics& at, int geom1, int geom2) const {
  const mjModel& model = at.model();
  const mjData& data = at.data();
  const double radius1 = model.geom_rbound[geom1], radius2 = model.geom_rbound[geom2];
  const Vector3d offset = Eigen::Map<const Vector3d>(data.geom_xpos + 3 * geom2) -
                          Eigen::Map<const Vector3d>(data.geom_xpos + 3 * geom1);
  const double reach = radius1 + radius2 + options_.detection_distance;
  if (radius1 > 0 && radius2 > 0) return offset.squaredNorm() <= reach * reach;
  const auto above = [&](int plane, const Vector3d& d) {
    const double* R = data.geom_xmat + 9 * plane;
    return R[2] * d.x() + R[5] * d.y() + R[8] * d.z() <= reach;
  };
  if (model.geom_type[geom1] == mjGEOM_PLANE && radius2 > 0) return above(geom1, offset);
  if (model.geom_type[geom2] == mjGEOM_PLANE && radius1 > 0) return above(geom2, -offset);
  return true;
}

void CollisionRows::add_to(ConstraintRows rows, Kinematics& at, double) {
  const double farthest = options_.detection_distance;
  const auto nearer = [](const Near& a, const Near& b) { return a.distance < b.distance; };
  size_t count = 0;  // of near_, which becomes a heap with the farthest first once it is full
  for (size_t pair = 0; pair < pairs_.size(); ++pair) {
    const auto [geom1, geom2] = pairs_[pair];
    if (!may_be_near(at, geom1, geom2)) continue;
    double segment[6];
    const double distance =
        mj_geomDistance(&at.model(), &at.data(), geom1, geom2, farthest, segment);
    if (std::abs(distance - farthest) < 1e-12) continue;
    const Near near{distance, static_cast<int>(pair), Vector3d(segment), Vector3d(segment + 3)};
    if (count < near_.size()) {
      near_[count++] = near;
      if (count == near_.size()) std::ranges::make_heap(near_, nearer);
    } else if (distance < near_.front().distance) {
      std::ranges::pop_heap(near_, nearer);
      near_.back() = near;
      std::ranges::push_heap(near_, nearer);
    }
  }
  for (size_t i = 0; i < count; ++i) write(rows, static_cast<int>(i), near_[i], at);
}

void CollisionRows::write(ConstraintRows rows, int row, const Near& near, Kinematics& at) {
  const auto [geom1, geom2] = pairs_[static_cast<size_t>(near.pair)];
  const double length = (near.to - near.from).norm();
  if (!(length > 0)) return;  // touching points have no normal
  const Vector3d normal = (near.to - near.from) / length;
  at.point_jacobian(at.model().geom_bodyid[geom1], near.from, J1_);
  at.point_jacobian(at.model().geom_bodyid[geom2], near.to, J2_);
  const double sign = near.distance >= 0 ? -1 : 1;  // of a penetration the points change places
  rows.row(row).noalias() = sign * normal.transpose().lazyProduct(J2_ - J1_);
  const double left = near.distance - options_.min_distance;
  rows.bound(row) = std::max(left, 0.0) * options_.gain + options_.bound_relaxation;
}

}  // namespace gloam::ik

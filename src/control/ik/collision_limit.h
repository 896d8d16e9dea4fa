#pragma once
// CollisionLimit, between pairs of geoms.

#include "control/ik/constraints.h"

namespace gloam::ik {

using GeomPairs = std::vector<std::pair<int, int>>;

/// Pairs of a limit's groups, ascending and unique. Errors: unknown geoms.
Result<GeomPairs> collision_pairs(const mjModel& model, const CollisionLimit& options);
/// True unless both are of one body or of welded bodies, of parent and child, or excluded by
/// contype and conaffinity.
bool may_collide(const mjModel& model, int geom1, int geom2);

class CollisionRows {
 public:
  /// `most`: inequalities at most, for the nearest pairs.
  static Result<CollisionRows> create(const Kinematics& at, const CollisionLimit& options,
                                      GeomPairs pairs, int most);
  int count() const { return static_cast<int>(near_.size()); }
  void add_to(ConstraintRows rows, Kinematics& at, double dt);

 private:
  struct Near {
    double distance;  // [m], negative = penetration
    int pair;
    Vector3d from, to;  // nearest points of the two geoms, world [m]
  };
  bool may_be_near(const Kinematics& at, int geom1, int geom2) const;
  void write(ConstraintRows rows, int row, const Near& near, Kinematics& at);

  CollisionLimit options_;
  GeomPairs pairs_;
  std::vector<Near> near_;
  MatrixXd J1_, J2_;  // (3 x n)
};

}  // namespace gloam::ik

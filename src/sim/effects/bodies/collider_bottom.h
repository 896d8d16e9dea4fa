#pragma once
// The underside of a convex collider, as seen from straight below: spheres, ellipsoids, capsules,
// cylinders, boxes, and the convex hulls of meshes. Closed forms.

#include <mujoco/mujoco.h>

#include <span>
#include <vector>

#include "sim/effects/bodies/grid_solid.h"

namespace gloam {

/// The lowest point of a collider over a point of the plane, in the world.
struct BottomPoint {
  double z = 0;          ///< [m]
  double slope[2] = {};  ///< dz/dx, dz/dy of the surface there
};

class ColliderBottom {
 public:
  /// True if the geom is supported: planes, height fields and SDFs are not.
  static bool can_be(const mjModel& model, int geom);
  ColliderBottom(const mjModel& model, int geom);

  int geom() const { return geom_; }
  int body() const { return body_; }
  /// Takes the geom's pose from `data`. Call it before the functions below.
  void set_pose(const mjData& data);
  /// Bounding box in the world [m].
  double low(int axis) const { return centre_[axis] - half_[axis]; }
  double high(int axis) const { return centre_[axis] + half_[axis]; }
  /// Bounding box of the part lower than `level`, which is not empty: (x, y) each [m].
  void box_below(double level, double* low, double* high) const;
  /// A point of the geom's frame whose motion tells how that part of its surface moves which is at
  /// `point` in the world: spinning about an axis of revolution does not move it.
  void anchor_of(const double* point, double* p_G) const;
  /// Angle to an orientation `R`, ignoring symmetries of the shape [rad], a lower bound.
  double turned(const double* R) const;
  const double* position() const { return p_; }
  const double* rotation() const { return R_; }
  /// False: it is not above (x, y).
  bool at(double x, double y, BottomPoint* out) const;
  /// At many places; z = kNoSurface: it is not above that one.
  void at_each(std::span<const double> xs, const double* ys, double* z, double* slope_x,
               double* slope_y) const;
  /// Only how high [m].
  bool height_at(double x, double y, double* z) const;
  bool is_round() const { return type_ == mjGEOM_SPHERE || type_ == mjGEOM_CAPSULE; }
  /// Interval of x in which a round geom is lower than `level`, for each of `ys`; left > right:
  /// none.
  void round_ends(double level, std::span<const double> ys, double* left, double* right) const;

  static constexpr double kNoSurface = 1e30;  ///< [m]

 private:
  struct Facet {
    double a, b, c;  // z = a x + b y + c
  };
  double reach(const double* n) const;
  const Facet* facet_at(double x, double y, double* z) const;
  bool quadric_at(double x, double y, double* t, double* normal) const;
  bool cylinder_at(const double* o, const double* d, double* t, double* normal) const;
  void round_at(std::span<const double> xs, const double* ys, double* z, double* slope_x,
                double* slope_y) const;

  int geom_, body_, type_;
  double size_[3], box_centre_[3], box_half_[3];
  std::vector<SolidPlane> planes_;  // planes of boxes and hulls, in the geom's frame
  double p_[3] = {}, R_[9] = {};
  double p_G_[3] = {};  // the world's origin in the geom's frame
  // Terms of cylinders: 1 / (x² + y²), 1 / z of upright lines
  double per_round_ = 0, per_upright_ = 0;
  double centre_[3] = {}, half_[3] = {};
  std::vector<Facet> lower_, upper_;
  std::vector<SolidPlane> upright_;  // in the world; n[2] = 0
};

}  // namespace gloam

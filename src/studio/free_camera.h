#pragma once
// Geometry of the mouse: the free camera that orbits a pivot, and the plane a body is dragged in.

#include <optional>

#include "gloam/camera.h"
#include "gloam/types.h"

namespace gloam::studio {

Vec3 operator+(const Vec3& a, const Vec3& b);
Vec3 operator-(const Vec3& a, const Vec3& b);
Vec3 operator*(double s, const Vec3& a);
double dot(const Vec3& a, const Vec3& b);
double norm(const Vec3& a);
/// R(q) v for a unit quaternion.
Vec3 rotate(const Quat& q, const Vec3& v);

/// Distance of a point in front of the camera, along its optical axis [m].
double depth_of(const Pose& X_WC, const Vec3& p_W);
/// Depth [m] of a point as CameraFrame::depth: of fisheyes and panoramas along the ray.
double depth_of(const Pose& X_WC, const Intrinsics& intrinsics, const Vec3& p_W);

/// The point at such a depth that is seen at (u, v) [px]; none where the lens sees nothing.
std::optional<Vec3> point_at(const Pose& X_WC, const Intrinsics& intrinsics, double u, double v,
                             double depth);

/// A camera that looks at a pivot and stays upright (Z up).
class OrbitCamera {
 public:
  /// Takes over a pose; the pivot lies `distance` [m] in front of it. A roll is lost.
  OrbitCamera(const Pose& X_WC, double distance);

  void orbit(double dx, double dy);  ///< 1 = half a turn; right, down
  /// `view_height` = what the picture shows from top to bottom at the pivot's distance [m].
  void pan(double dx, double dy, double view_height);
  void zoom(double amount);  ///< multiplies the distance by exp(-amount), 1 cm … 10 km

  Pose pose() const;  ///< X_WC; looks along -Z
  double distance() const { return distance_; }
  const Vec3& pivot() const { return pivot_; }
  /// Moves the pivot and the camera with it.
  void set_pivot(const Vec3& pivot_W) { pivot_ = pivot_W; }

 private:
  Vec3 forward() const;

  Vec3 pivot_;            // [m]
  double azimuth_ = 0;    // of the viewing direction, from +X about +Z [rad]
  double elevation_ = 0;  // of the viewing direction above the horizon [rad]
  double distance_ = 1;   // [m]
};

}  // namespace gloam::studio
